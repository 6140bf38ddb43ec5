"use strict";

/* Colours and numbers: maps of equal perceived steps, round ticks, short numbers. */

/* Viridis (van der Walt, Smith 2015), cividis (Nuñez, Anderton, Renslow 2018) and a diverging map from
   ColorBrewer (Brewer 2003), each at even places; between them colours are linear. */
const MAPS = {
  viridis: ["440154", "482878", "3e4989", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"],
  cividis: ["00224e", "123570", "3b496c", "575d6d", "707173", "8a8678", "a59c74", "c3b369", "e1cc55", "fee838"],
  "blue to red": ["2166ac", "4393c3", "92c5de", "d1e5f0", "f7f7f7", "fddbc7", "f4a582", "d6604d", "b2182b"],
  greys: ["f2f2f2", "333333"],
};

/* Open, slip and stick (Okabe, Ito 2008). */
const STATES = [
  { word: "open", colour: [236, 239, 242] },
  { word: "slip", colour: [213, 94, 0] },
  { word: "stick", colour: [0, 114, 178] },
];

/* Values that do not exist; the grey they are drawn in. */
const BLANK = -3e38;
const GREY = [176, 184, 192];

const BANDS = 10;

function rgb(hex) {
  return [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/* 256 colours, three bytes each; with bands as many steps. */
function colours(name, bands) {
  const anchors = (MAPS[name] || MAPS.viridis).map(rgb);
  const table = new Uint8Array(3 * 256);
  for (let i = 0; i < 256; i++) {
    let part = i / 255;
    if (bands) part = Math.min(Math.floor((i / 256) * BANDS), BANDS - 1) / (BANDS - 1);
    const place = part * (anchors.length - 1);
    const low = Math.min(Math.floor(place), anchors.length - 2);
    for (let k = 0; k < 3; k++) {
      table[3 * i + k] = Math.round(anchors[low][k] + (place - low) * (anchors[low + 1][k] - anchors[low][k]));
    }
  }
  return table;
}

/* The three states, a third of the table each. */
function stateColours() {
  const table = new Uint8Array(3 * 256);
  for (let i = 0; i < 256; i++) table.set(STATES[Math.min(Math.floor((3 * i) / 256), 2)].colour, 3 * i);
  return table;
}

function css([r, g, b], alpha = 1) {
  return `rgba(${r}, ${g}, ${b}, ${alpha})`;
}

/* Four digits. */
function shortNumber(value) {
  if (value === null || value === undefined || Number.isNaN(value) || value <= BLANK) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const digits = Number(value.toPrecision(4));
  return (size >= 1e5 || size < 1e-3 ? digits.toExponential() : String(digits)).replace("e+", "e").replaceAll("-", "−");
}

/* Round values from low to high, about `count` of them. */
function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * (1 - 1e-9));
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k === 0 ? 0 : k * step);
  return found;
}
