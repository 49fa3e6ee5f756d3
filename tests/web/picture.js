// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What screenshots show, in numbers: pictures are compared in structure, not in bytes. All of it is
// worked out in a page of the browser, which can read PNG; functions given to evaluate() run there.
'use strict';

// lit: share of pixels that are not white; colours: how many of 32^3; blue, red: shares of pixels
// in which that channel leads by 25 levels; cells: share of lit pixels in each of 16 x 10 cells.
async function look(base64) {
  const image = new Image();
  image.src = `data:image/png;base64,${base64}`;
  await image.decode();
  const {width, height} = image;
  const context = new OffscreenCanvas(width, height).getContext('2d');
  context.drawImage(image, 0, 0);
  const rgba = context.getImageData(0, 0, width, height).data;
  const cells = new Array(160).fill(0), colours = new Set();
  let lit = 0, blue = 0, red = 0;
  for (let i = 0; i < rgba.length; i += 4) {
    if (rgba[i] >= 250 && rgba[i + 1] >= 250 && rgba[i + 2] >= 250) continue;
    const x = i / 4 % width, y = Math.floor(i / 4 / width);
    ++lit;
    cells[16 * Math.floor(10 * y / height) + Math.floor(16 * x / width)] += 1;
    colours.add((rgba[i] >> 3) << 10 | (rgba[i + 1] >> 3) << 5 | rgba[i + 2] >> 3);
    if (rgba[i + 2] > rgba[i] + 25) ++blue;
    if (rgba[i] > rgba[i + 2] + 25) ++red;
  }
  window.pictures = window.pictures || [];
  const id = window.pictures.push({width, height, rgba}) - 1, all = width * height;
  return {id, lit: lit / all, colours: colours.size, blue: blue / all, red: red / all,
          cells: cells.map(count => 160 * count / all)};
}

// Share of pixels that differ by more than 12 levels in some channel.
function changed([a, b]) {
  const first = window.pictures[a], second = window.pictures[b];
  if (first.width !== second.width || first.height !== second.height) return 1;
  let count = 0;
  for (let i = 0; i < first.rgba.length; i += 4)
    if (Math.abs(first.rgba[i] - second.rgba[i]) > 12 ||
        Math.abs(first.rgba[i + 1] - second.rgba[i + 1]) > 12 ||
        Math.abs(first.rgba[i + 2] - second.rgba[i + 2]) > 12)
      ++count;
  return count / (first.width * first.height);
}

// `blank` is a page on which nothing but this runs.
const structureOf = (blank, png) => blank.evaluate(look, png.toString('base64'));
const changedShare = (blank, a, b) => blank.evaluate(changed, [a.id, b.id]);

// How much two pictures light the same cells: 1 for equal ones, 0 where none is common.
function commonCells(a, b) {
  let both = 0, either = 0;
  a.cells.forEach((share, k) => {
    both += Math.min(share, b.cells[k]);
    either += Math.max(share, b.cells[k]);
  });
  return both / either;
}

module.exports = {structureOf, changedShare, commonCells};
