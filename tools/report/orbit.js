// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Turning a camera about a place by mouse, touch and keyboard; z stays up.
'use strict';

const orbitSides = {  // azimuth and elevation in radians
  front: [-Math.PI / 2, 0], right: [0, 0], back: [Math.PI / 2, 0], left: [Math.PI, 0],
  top: [-Math.PI / 2, Math.PI / 2], bottom: [-Math.PI / 2, -Math.PI / 2],
  oblique: [Math.atan2(-0.75, 0.55), Math.atan2(0.45, Math.hypot(0.55, 0.75))],
};

class Orbit {
  // `changed` is called whenever the picture must be drawn anew.
  constructor(camera, canvas, changed) {
    Object.assign(this, {camera, canvas, changed, pointers: new Map()});
    this.target = new THREE.Vector3();
    this.home = [new THREE.Vector3()];
    this.radius = 1;
    [this.azimuth, this.elevation] = orbitSides.oblique;
    canvas.addEventListener('pointerdown', event => this.press(event));
    canvas.addEventListener('pointermove', event => this.drag(event));
    for (const end of ['pointerup', 'pointercancel'])
      canvas.addEventListener(end, event => this.pointers.delete(event.pointerId));
    canvas.addEventListener('wheel', event => this.wheel(event), {passive: false});
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    canvas.addEventListener('keydown', event => this.key(event));
  }

  // Brings these places into view, from the present side; Home comes back to them.
  frame(places) {
    this.home = places;
    const box = new THREE.Box3().setFromPoints(places);
    box.getCenter(this.target);
    this.radius = Math.max(box.min.distanceTo(box.max) / 2, 1e-9);
    const {right, up, away} = this.axes();
    const high = Math.tan(this.camera.fov * Math.PI / 360), wide = high * this.camera.aspect;
    this.distance = 1.08 * Math.max(...places.map(place => {
      const from = place.clone().sub(this.target);
      const across = Math.max(Math.abs(from.dot(right)) / wide, Math.abs(from.dot(up)) / high);
      return from.dot(away) + across;
    }));
    this.place();
  }

  look(side) {
    [this.azimuth, this.elevation] = orbitSides[side];
    this.frame(this.home);
  }

  // Seen from a pole the azimuth still tells which side is up.
  axes() {
    const [ca, sa] = [Math.cos(this.azimuth), Math.sin(this.azimuth)];
    const [ce, se] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    return {right: new THREE.Vector3(-sa, ca, 0), up: new THREE.Vector3(-se * ca, -se * sa, ce),
            away: new THREE.Vector3(ce * ca, ce * sa, se)};
  }

  place() {
    const {up, away} = this.axes();
    this.camera.position.copy(this.target).addScaledVector(away, this.distance);
    this.camera.up.copy(up);
    this.camera.lookAt(this.target);
    this.camera.near = this.distance / 200;
    this.camera.far = this.distance + 20 * this.radius;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.changed();
  }

  turn(across, down) {
    this.azimuth -= across;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + down));
    this.place();
  }

  // In pixels of the canvas.
  shift(across, down) {
    const metres = 2 * this.distance * Math.tan(this.camera.fov * Math.PI / 360) /
        this.canvas.clientHeight;
    const {right, up} = this.axes();
    this.target.addScaledVector(right, -across * metres).addScaledVector(up, down * metres);
    this.place();
  }

  zoom(factor) {
    this.distance = Math.max(this.radius / 50, Math.min(20 * this.radius, this.distance * factor));
    this.place();
  }

  press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const across = event.clientX - before[0], down = event.clientY - before[1];
    const other = [...this.pointers].find(([id]) => id !== event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (other) {
      const gap = at => Math.hypot(at[0] - other[1][0], at[1] - other[1][1]);
      this.zoom(gap(before) / Math.max(1, gap([event.clientX, event.clientY])));
      this.shift(across / 2, down / 2);
    } else if (event.buttons & 2 || event.shiftKey) {
      this.shift(across, down);
    } else {
      this.turn(across * 0.008, down * 0.008);
    }
  }

  wheel(event) {
    event.preventDefault();
    this.zoom(Math.exp(Math.max(-1, Math.min(1, event.deltaY * 0.0015))));
  }

  key(event) {
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    const step = arrows[event.key];
    if (step && event.shiftKey) this.shift(30 * step[0], 30 * step[1]);
    else if (step) this.turn(0.12 * step[0], 0.12 * step[1]);
    else if (event.key === '+' || event.key === '=') this.zoom(0.85);
    else if (event.key === '-') this.zoom(1 / 0.85);
    else if (event.key === 'Home') this.look('oblique');
    else return;
    event.preventDefault();
  }
}
