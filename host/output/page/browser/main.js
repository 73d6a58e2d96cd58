// The page comes up with what the run is about: a deformation, multipath, or the distance.

function firstQuantity() {
  const quantities = shown.frame.channels.map(channel => channel.quantity);
  const first = ['deformation_mm', 'correction_mm', 'multipath_m', 'unwrapped_distance_m', 'distance_m', 'amplitude'];
  return first.find(name => quantities.includes(name)) ?? quantities[0];
}

// Paper is light, and what is drawn on it must be there at once.
function setPaper(isPaper) {
  document.documentElement.toggleAttribute('data-paper', isPaper);
  drawNow(new Set(['values', 'others']));
}

function begin() {
  writeRun();
  fillSensors();
  shown.quantity = firstQuantity();
  chooseSensor(0).then(() => { document.documentElement.dataset.ready = 'yes'; });
  new ResizeObserver(() => redraw('values')).observe(document.querySelector('main'));
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => redraw('values'));
  addEventListener('beforeprint', () => setPaper(true));
  addEventListener('afterprint', () => setPaper(false));
}

// For scripts and tests: what is shown, and the values behind it.
window.report = {run, shown, cloud, pictureBox: () => pictureBox};
begin();
