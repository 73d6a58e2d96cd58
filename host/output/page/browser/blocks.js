// The run as the page carries it: its description, and its values, which are unpacked when they are asked for.
'use strict';

const run = JSON.parse(document.getElementById('run').textContent);

// What was unpacked last stays, up to so many bytes.
const unpackedLimit = 400e6;
const unpacked = new Map(); // block -> promise of values, the one used last at the end
let unpackedBytes = 0;

function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function unzipped(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// All first bytes of the values come first, then all second ones, and so on.
function unshuffled(planes, bytesOfValue) {
  const count = planes.length / bytesOfValue;
  const bytes = new Uint8Array(planes.length);
  for (let plane = 0; plane < bytesOfValue; ++plane)
    for (let i = 0, at = plane * count; i < count; ++i) bytes[i * bytesOfValue + plane] = planes[at + i];
  return bytes.buffer;
}

async function unpack(channel) {
  const element = document.getElementById(`block-${channel.block}`);
  const Values = {f4: Float32Array, f8: Float64Array, u4: Uint32Array}[channel.kind];
  const values = new Values(unshuffled(await unzipped(bytesOfBase64(element.textContent)), Values.BYTES_PER_ELEMENT));
  unpackedBytes += values.byteLength;
  return values;
}

function forgetOldest() {
  for (const [block, values] of unpacked) {
    if (unpackedBytes <= unpackedLimit || unpacked.size < 2) return;
    unpacked.delete(block);
    values.then(gone => { unpackedBytes -= gone.byteLength; });
    return;
  }
}

// The channel's values, row by row, as a promise.
function valuesOf(channel) {
  const values = unpacked.get(channel.block) ?? unpack(channel);
  unpacked.delete(channel.block);
  unpacked.set(channel.block, values);
  forgetOldest();
  return values;
}

// What an id says where nothing is hit.
const noId = 0xffffffff;
const isNumbered = channel => channel.scale === 'ids' || channel.scale === 'bits'; // a colour for each number
const isId = channel => channel.scale === 'ids';
const isInteger = channel => channel.kind === 'u4';

// Names of objects by their ids, from the manifest, which may have none: a list of names, a list of objects with id
// and name, or an object whose keys are the ids.
function namesOfObjects(objects) {
  const names = new Map();
  const add = (id, name) => { if (Number.isInteger(id) && typeof name === 'string') names.set(id, name); };
  if (Array.isArray(objects))
    objects.forEach((object, i) => add(object?.id ?? object?.object_id ?? i, object?.name ?? object));
  else if (objects && typeof objects === 'object')
    for (const [id, object] of Object.entries(objects)) add(Number(id), object?.name ?? object);
  return names;
}
