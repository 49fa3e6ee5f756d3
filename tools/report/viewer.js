// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The 3D view: takes the place of the picture where there is WebGL.
'use strict';

const byId = id => document.getElementById(id);

class Viewer {
  constructor(data) {
    this.data = data;
    this.canvas = byId('canvas');
    this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, antialias: true});
    this.renderer.setClearColor(0xffffff);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.1, 100);
    this.orbit = new Orbit(this.camera, this.canvas, () => this.draw());
    this.corners = [0, 1, 2, 3, 4, 5, 6, 7].map(k => new THREE.Vector3(
        data.box[k & 1][0], data.box[k >> 1 & 1][1], data.box[k >> 2][2]));
    this.step = data.steps.length - 1;
  }

  async load() {
    if (this.data.surface) {
      this.surface = discCloud(await unpackedPoints(this.data.surface));
      this.scene.add(this.surface);
    }
    this.scans = [];
    for (const [i, scan] of this.data.scans.entries()) {
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      group.cloud = discCloud(await unpackedPoints(scan.points));
      group.glyph = scannerGlyph(scan.viewpoint_m, scan.aim, 0.18 * scan.reach_m, scanColour(i));
      group.glyph.visible = false;
      paintCloud(group.cloud, () => scanColour(i));
      group.add(group.cloud, group.glyph);
      this.scans.push(group);
      this.scene.add(group);
    }
    this.pins = this.data.call_outs.map(place => this.pin(place));
  }

  pin(place) {
    const element = document.createElement('span');
    element.className = 'pin';
    element.textContent = place.number;
    element.setAttribute('aria-hidden', 'true');
    byId('stage').append(element);
    return {element, at: new THREE.Vector3(...place.position_m),
            normal: new THREE.Vector3(...place.normal)};
  }

  // Fills the canvas with pixels as the screen has them, two a point at most.
  resize() {
    const {clientWidth: width, clientHeight: height} = byId('stage');
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  // Once a frame, however often it is asked for.
  draw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.drawNow();
    });
  }

  drawNow() {
    const perMetre = this.renderer.domElement.height /
        (2 * Math.tan(this.camera.fov * Math.PI / 360));
    const size = (cloud, spacings) => {
      cloud.material.uniforms.diameter.value = spacings * cloud.userData.spacing * perMetre;
    };
    if (this.surface) size(this.surface, 1.9);  // closed
    for (const group of this.scans) size(group.cloud, 1.1);  // several lie on each other
    this.renderer.render(this.scene, this.camera);
    this.placePins();
    document.body.dataset.frames = Number(document.body.dataset.frames || 0) + 1;
  }

  placePins() {
    const shown = byId('pins') && byId('pins').checked && this.colour !== 'scan';
    const {clientWidth: width, clientHeight: height} = byId('stage');
    for (const {element, at, normal} of this.pins) {
      const screen = at.clone().project(this.camera);
      element.hidden = !shown || Math.abs(screen.x) > 1 || Math.abs(screen.y) > 1 || screen.z > 1;
      element.style.left = `${(screen.x + 1) / 2 * width}px`;
      element.style.top = `${(1 - screen.y) / 2 * height}px`;
      element.classList.toggle('behind', normal.dot(this.camera.position.clone().sub(at)) < 0);
    }
  }

  // deviation, normal, support: of the surface; scan: the scans' points.
  show(colour) {
    this.colour = colour;
    if (this.surface) this.surface.visible = colour !== 'scan';
    for (const group of this.scans) group.cloud.visible = colour === 'scan';
    const key = byId('key');
    if (colour === 'deviation') key.replaceChildren(...this.paintDeviation());
    if (colour === 'normal') key.replaceChildren(...this.paintNormals());
    if (colour === 'support') key.replaceChildren(...this.paintSupport());
    if (colour === 'scan') key.replaceChildren(...this.scanKey());
    this.draw();
  }

  paintDeviation() {
    const {deviation} = this.surface.userData.points, limit = this.data.limit_m;
    paintCloud(this.surface, i => scaleColour(this.data.colours, 0.5 + deviation[i] / limit / 2));
    return keyBar(this.data.colours, `${readableLength(-limit)} (inside)`,
                  `+${readableLength(limit)} (outside)`);
  }

  paintNormals() {
    const {normal} = this.surface.userData.points;
    paintCloud(this.surface, i => normalColour(normal, i));
    return [keyDot([255, 128, 128], '+x'), keyDot([128, 255, 128], '+y'),
            keyDot([128, 128, 255], '+z'), keyText('opposite directions are the dark complements')];
  }

  paintSupport() {
    const {support} = this.surface.userData.points, most = upperValue(support);
    paintCloud(this.surface, i => scaleColour(supportScale, support[i] / most));
    return keyBar(supportScale, '0 m', `${readableLength(most)} to the nearest point`);
  }

  scanKey() {
    const most = 24, names = this.data.scans.map((scan, i) => keyDot(scanColour(i), scan.name));
    return names.length <= most ? names
        : names.slice(0, most).concat(keyText(`and ${names.length - most} more`));
  }

  // The scans as they lay after a step of the alignment.
  setStep(k) {
    this.step = k;
    const step = this.data.steps[k];
    this.scans.forEach((group, i) => {
      const [x, y, z, qx, qy, qz, qw] = step.poses[i];
      group.matrix.compose(new THREE.Vector3(x, y, z), new THREE.Quaternion(qx, qy, qz, qw),
                           new THREE.Vector3(1, 1, 1));
      group.updateMatrixWorld(true);
    });
    byId('step-name').textContent = step.off_m > 0
        ? `${step.step}: ${readableLength(step.off_m)} off the result, on average` : step.step;
    this.draw();
  }

  // With the scanners the view is wide enough to hold them.
  showScanners(shown) {
    const places = this.corners.slice();
    this.scans.forEach((group, i) => {
      group.glyph.visible = shown;
      const at = new THREE.Vector3(...this.data.scans[i].viewpoint_m).applyMatrix4(group.matrix);
      if (shown) places.push(at);
    });
    this.orbit.frame(places);
  }
}

function chooseColour(viewer, value) {
  const choice = document.querySelector(`input[name=colour][value=${value}]`);
  if (!choice) return;
  choice.checked = true;
  viewer.show(value);
}

function wireSlider(viewer) {
  const slider = byId('step'), play = byId('play');
  if (!slider) return;
  let timer = 0;
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = 'Play';
  };
  const go = k => {
    slider.value = k;
    if (viewer.colour !== 'scan') chooseColour(viewer, 'scan');
    viewer.setStep(k);
  };
  slider.addEventListener('input', () => {
    stop();
    go(Number(slider.value));
  });
  play.addEventListener('click', () => {
    if (timer) return stop();
    play.textContent = 'Pause';
    go(0);
    timer = setInterval(() => {
      if (viewer.step >= viewer.data.steps.length - 1) return stop();
      go(viewer.step + 1);
    }, 250);
  });
}

function wire(viewer) {
  for (const choice of document.querySelectorAll('input[name=colour]'))
    choice.addEventListener('change', () => viewer.show(choice.value));
  for (const button of document.querySelectorAll('button[data-view]'))
    button.addEventListener('click', () => viewer.orbit.look(button.dataset.view));
  if (byId('pins')) byId('pins').addEventListener('change', () => viewer.draw());
  const scanners = byId('scanners');
  if (scanners) scanners.addEventListener('change', () => viewer.showScanners(scanners.checked));
  wireSlider(viewer);
  new ResizeObserver(() => viewer.resize()).observe(byId('stage'));
}

function hasWebGl() {
  try {
    return Boolean(document.createElement('canvas').getContext('webgl'));
  } catch (error) {
    return false;
  }
}

async function startViewer() {
  const state = byId('viewer-state');
  if (!hasWebGl()) {
    state.textContent = 'This browser has no WebGL: the picture stands in for the 3D view.';
    document.body.dataset.viewer = 'no-webgl';
    return;
  }
  const script = document.createElement('script');  // allowed by its hash in the page's policy
  script.textContent = new TextDecoder().decode(
      await inflatedBytes(byId('three-packed').textContent));
  document.head.append(script);
  const viewer = new Viewer(JSON.parse(byId('scene').textContent));
  await viewer.load();
  viewer.canvas.hidden = false;
  byId('viewer').classList.remove('no-webgl');
  state.textContent = '';
  viewer.resize();
  if (viewer.scans.length) viewer.setStep(viewer.step);
  chooseColour(viewer, document.querySelector('input[name=colour]').value);
  wire(viewer);
  viewer.orbit.frame(viewer.corners);
  document.body.dataset.viewer = 'ready';
}

startViewer().catch(error => {
  byId('canvas').hidden = true;
  byId('viewer').classList.add('no-webgl');
  byId('viewer-state').textContent = `The 3D view cannot start here (${error.message}).`;
  document.body.dataset.viewer = 'failed';
});
