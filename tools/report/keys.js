// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Colour scales of the 3D view and their keys.
'use strict';

// Okabe and Ito 2008: distinct for the colour-blind too; beyond seven scans they come again, paler.
const scanPalette = [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0],
                     [86, 180, 233], [90, 90, 90]];

function scanColour(index) {
  const round = Math.floor(index / scanPalette.length) % 3;
  return scanPalette[index % scanPalette.length].map(v => Math.round(v + (255 - v) * 0.25 * round));
}

// Even in lightness, dark blue to yellow (after cividis, Nunez et al. 2018).
const supportScale = [[0, 32, 77], [59, 74, 108], [124, 123, 120], [188, 175, 111], [255, 234, 70]];

// `share` from 0 to 1 along equally spaced colours.
function scaleColour(scale, share) {
  const place = Math.max(0, Math.min(1, share)) * (scale.length - 1);
  const low = Math.min(scale.length - 2, Math.floor(place)), part = place - low;
  return scale[low].map((v, k) => Math.round(v + part * (scale[low + 1][k] - v)));
}

function normalColour(normals, i) {
  return [0, 1, 2].map(k => Math.round(255 * (0.5 + 0.5 * normals[3 * i + k])));
}

// What 99 of 100 values do not exceed.
function upperValue(values) {
  const sorted = Float32Array.from(values).sort();
  return sorted[Math.floor(0.99 * (sorted.length - 1))];
}

// "123 µm": three significant digits with the unit that suits.
function readableLength(metres) {
  const size = Math.abs(metres);
  if (size === 0) return '0 m';
  const [factor, unit] = size < 1e-6 ? [1e9, 'nm'] : size < 1e-3 ? [1e6, 'µm']
      : size < 1 ? [1e3, 'mm'] : [1, 'm'];
  return Number((metres * factor).toPrecision(3)) + ' ' + unit;
}

function keyText(text) {
  const element = document.createElement('span');
  element.textContent = text;
  return element;
}

function keyBar(scale, low, high) {
  const bar = document.createElement('canvas');
  [bar.width, bar.height] = [256, 1];
  const context = bar.getContext('2d'), row = context.createImageData(256, 1);
  for (let x = 0; x < 256; ++x) row.data.set([...scaleColour(scale, x / 255), 255], 4 * x);
  context.putImageData(row, 0, 0);
  return [keyText(low), bar, keyText(high)];
}

function keyDot(colour, text) {
  const element = keyText(text), dot = document.createElement('span');
  dot.className = 'dot';
  dot.style.background = `rgb(${colour})`;
  element.prepend(dot);
  return element;
}
