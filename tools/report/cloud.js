// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points as shaded discs, and scanners as small frusta.
'use strict';

const discVertex = `
attribute vec3 tint;
uniform float diameter;  // of a disc: metres times pixels of a metre at distance 1
varying vec3 colour;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  float facing = abs(dot(normalize(normalMatrix * normal), normalize(at.xyz)));
  colour = tint * (0.35 + 0.65 * facing);
  gl_Position = projectionMatrix * at;
  gl_PointSize = clamp(diameter / -at.z, 1.5, 40.0);
}`;

const discFragment = `
varying vec3 colour;
void main() {
  vec2 off = gl_PointCoord - 0.5;
  if (dot(off, off) > 0.25) discard;
  gl_FragColor = vec4(colour, 1.0);
}`;

// How far apart neighbours are: the median distance from one point to the next on the curve along
// which they are stored.
function spacing(position) {
  const gaps = [];
  for (let i = 3; i < position.length; i += 3)
    gaps.push(Math.hypot(position[i] - position[i - 3], position[i + 1] - position[i - 2],
                         position[i + 2] - position[i - 1]));
  gaps.sort((a, b) => a - b);
  return gaps.length ? gaps[gaps.length >> 1] : 0;
}

// THREE.Points; userData: spacing and the unpacked points.
function discCloud(points) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(points.position, 3));
  const normal = points.normal || new Float32Array(3 * points.count).fill(1);
  geometry.setAttribute('normal', new THREE.BufferAttribute(normal, 3));
  const tint = new THREE.BufferAttribute(new Uint8Array(3 * points.count).fill(180), 3, true);
  geometry.setAttribute('tint', tint);
  const material = new THREE.ShaderMaterial({
    vertexShader: discVertex, fragmentShader: discFragment, uniforms: {diameter: {value: 1}},
  });
  const cloud = new THREE.Points(geometry, material);
  cloud.frustumCulled = false;
  cloud.userData = {points, spacing: spacing(points.position)};
  return cloud;
}

// `colourOf(i)` gives [red, green, blue] from 0 to 255.
function paintCloud(cloud, colourOf) {
  const tint = cloud.geometry.getAttribute('tint');
  for (let i = 0; i < tint.count; ++i) tint.array.set(colourOf(i), 3 * i);
  tint.needsUpdate = true;
}

// Apex at the viewpoint, opening along the aim; the axes x, y, z in red, green, blue.
function scannerGlyph(viewpoint, aim, size, colour) {
  const apex = new THREE.Vector3(...viewpoint), ahead = new THREE.Vector3(...aim);
  const side = Math.abs(ahead.y) < 0.9 ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(1, 0, 0);
  const right = side.clone().cross(ahead).normalize(), up = ahead.clone().cross(right);
  const corners = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) =>
    apex.clone().addScaledVector(ahead, size).addScaledVector(right, 0.45 * size * a)
        .addScaledVector(up, 0.35 * size * b));
  const points = [], colours = [];
  const line = (a, b, shade) => {
    points.push(a, b);
    colours.push(...shade, ...shade);
  };
  const shade = colour.map(v => v / 255);
  corners.forEach((corner, i) => {
    line(apex, corner, shade);
    line(corner, corners[(i + 1) % 4], shade);
  });
  const axes = [[0.8, 0, 0], [0, 0.55, 0], [0, 0.2, 0.9]];
  axes.forEach((tone, k) => {
    const end = apex.clone();
    end.setComponent(k, end.getComponent(k) + 0.7 * size);
    line(apex, end, tone);
  });
  const geometry = new THREE.BufferGeometry().setFromPoints(points);
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
  const glyph = new THREE.LineSegments(
      geometry, new THREE.LineBasicMaterial({vertexColors: THREE.VertexColors}));
  glyph.frustumCulled = false;
  return glyph;
}
