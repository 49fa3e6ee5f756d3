// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Reads what point_pack.cpp wrote.
'use strict';

async function inflatedBytes(base64) {
  const packed = Uint8Array.from(atob(base64), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// One channel: low bytes of all points, then the high ones, of zigzag differences.
function channelValues(bytes, start, count, channel) {
  const values = new Float32Array(count);
  let steps = 0;
  for (let i = 0; i < count; ++i) {
    const coded = bytes[start + i] | bytes[start + count + i] << 8;
    steps = (steps + (coded >> 1 ^ -(coded & 1))) & 0xffff;
    values[i] = channel.low + channel.step * steps;
  }
  return values;
}

// The octahedral map back onto the sphere, three numbers a point.
function unitNormals(u, v) {
  const normals = new Float32Array(3 * u.length);
  for (let i = 0; i < u.length; ++i) {
    const z = 1 - Math.abs(u[i]) - Math.abs(v[i]);
    const fold = Math.max(-z, 0);
    const x = u[i] - Math.sign(u[i]) * fold, y = v[i] - Math.sign(v[i]) * fold;
    const size = Math.hypot(x, y, z);
    normals.set([x / size, y / size, z / size], 3 * i);
  }
  return normals;
}

// {count, position: 3 numbers a point, normal: the same or null, deviation, support: or null}
async function unpackedPoints(packed) {
  const bytes = await inflatedBytes(packed.data);
  const found = {};
  packed.channels.forEach((channel, k) => {
    found[channel.name] = channelValues(bytes, 2 * packed.count * k, packed.count, channel);
  });
  const position = new Float32Array(3 * packed.count);
  for (let i = 0; i < packed.count; ++i)
    position.set([found.x[i], found.y[i], found.z[i]], 3 * i);
  return {
    count: packed.count,
    position,
    normal: found.normal_u ? unitNormals(found.normal_u, found.normal_v) : null,
    deviation: found.deviation || null,
    support: found.support || null,
  };
}
