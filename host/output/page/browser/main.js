// The page comes up with what the run is about: a deformation, multipath, or the distance.

function firstQuantity() {
  const quantities = shown.frame.channels.map(channel => channel.quantity);
  const first = ['deformation_mm', 'multipath_m', 'unwrapped_distance_m', 'distance_m', 'amplitude'];
  return first.find(name => quantities.includes(name)) ?? quantities[0];
}

function begin() {
  writeRun();
  fillSensors();
  shown.quantity = firstQuantity();
  chooseSensor(0).then(() => { document.documentElement.dataset.ready = 'yes'; });
  new ResizeObserver(() => redraw('values')).observe(document.querySelector('main'));
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => redraw('values'));
  // Paper is light, and has all that is folded.
  addEventListener('beforeprint', () => {
    for (const details of document.querySelectorAll('details')) details.open = true;
    redraw('values');
  });
}

// For scripts and tests: what is shown, and the values behind it.
window.report = {run, shown, cloud, pictureBox: () => pictureBox};
begin();
