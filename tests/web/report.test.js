// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The report's page as a reader meets it: opened from disk, without network, in Chromium.
//   node --test report.test.js   with LIBSCAN_REPORT (report.html, report.json beside it) and
//   CHROMIUM (the browser) in the environment
'use strict';

const assert = require('node:assert');
const fs = require('node:fs');
const {after, before, test} = require('node:test');
const {pathToFileURL} = require('node:url');
const {chromium} = require(process.env.PLAYWRIGHT || 'playwright-core');
const {structureOf, changedShare, commonCells, commonWarmth} = require('./picture.js');

const report = process.env.LIBSCAN_REPORT;
const twin = JSON.parse(fs.readFileSync(report.replace(/\.html$/, '.json'), 'utf8'));
const withWebGl = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const withoutWebGl = ['--disable-gpu', '--disable-software-rasterizer', '--disable-3d-apis'];

let browser, blank, page, seen;

function launch(flags) {
  return chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', ...flags]});
}

// A page of the report, and all that it complained of or asked for.
async function open(from, options = {}) {
  const context = await from.newContext({offline: true, viewport: {width: 800, height: 700},
                                         ...options});
  const opened = await context.newPage(), notes = {errors: [], requests: []};
  opened.on('pageerror', error => notes.errors.push(error.message));
  opened.on('console', message => {
    if (message.type() === 'error') notes.errors.push(message.text());
  });
  opened.on('request', request => {
    if (!request.url().startsWith('data:')) notes.requests.push(request.url());
  });
  await opened.goto(pathToFileURL(report).href);
  return [opened, notes];
}

const ready = of => of.waitForFunction(() => document.body.dataset.viewer);
const twoFrames = of => of.evaluate(() => new Promise(done =>
  requestAnimationFrame(() => requestAnimationFrame(done))));

async function stage() {
  await twoFrames(page);
  return structureOf(blank, await page.locator('#stage').screenshot());
}

const change = (a, b) => changedShare(blank, a, b);

before(async () => {
  browser = await launch(withWebGl);
  blank = await browser.newPage();
  [page, seen] = await open(browser);
  await ready(page);
});

after(() => browser.close());

test('the page loads from disk without errors or requests', async () => {
  assert.deepStrictEqual(seen.errors, []);
  assert.deepStrictEqual(seen.requests, [pathToFileURL(report).href]);
  assert.strictEqual(await page.evaluate(() => document.body.dataset.viewer), 'ready');
});

test('the canvas is lit as our own ray caster lights the picture behind it', async () => {
  await page.uncheck('#pins');
  const drawn = await stage();
  await page.evaluate(() => { document.getElementById('canvas').hidden = true; });
  const picture = await stage();
  await page.evaluate(() => { document.getElementById('canvas').hidden = false; });
  await page.check('#pins');
  assert.ok(drawn.lit > 0.08 && drawn.lit < 0.8, `lit ${drawn.lit}`);
  assert.ok(drawn.colours > 100, `${drawn.colours} colours`);
  assert.ok(drawn.blue + drawn.red > 0.001, `blue ${drawn.blue}, red ${drawn.red}`);
  // One is seen in perspective and somewhat smaller: most of what is lit must still be common.
  const common = commonCells(drawn, picture), warmth = commonWarmth(drawn, picture);
  assert.ok(common > 0.5, `common ${common}`);
  assert.ok(warmth > 0.5, `warmth ${warmth}`);
  console.log(`common cells ${common.toFixed(2)}, common warmth ${warmth.toFixed(2)}`);
});

test('every choice of colour changes the picture', async () => {
  let before = await stage();
  for (const colour of ['normal', 'support', 'scan', 'deviation']) {
    await page.check(`input[name=colour][value=${colour}]`);
    const now = await stage();
    assert.ok(await change(before, now) > 0.02, colour);
    assert.ok(now.lit > 0.05, colour);
    before = now;
  }
  assert.match(await page.textContent('#key'), /inside.*outside/);
});

test('every point of view shows another picture', async () => {
  let before = await stage();
  for (const side of ['front', 'right', 'back', 'left', 'top', 'bottom', 'oblique']) {
    await page.click(`button[data-view=${side}]`);
    const now = await stage();
    assert.ok(await change(before, now) > 0.01, side);
    assert.ok(now.lit > 0.05, side);
    before = now;
  }
});

test('the slider goes from the guesses to the result', async () => {
  const last = Number(await page.getAttribute('#step', 'max'));
  assert.ok(last > 4);
  await page.check('input[name=colour][value=scan]');
  const result = await stage();
  await page.fill('#step', '0');
  const guess = await stage();
  assert.match(await page.textContent('#step-name'), /^guess: [0-9.]+ (µm|mm) off the result/);
  const way = await change(result, guess);
  assert.ok(way > 0.005, `${way}`);
  await page.focus('#step');
  await page.keyboard.press('ArrowRight');
  assert.match(await page.textContent('#step-name'), /^pairs 1/);
  await page.keyboard.press('End');
  assert.strictEqual(await page.textContent('#step-name'), 'result');
  const back = await change(result, await stage());  // edges may fall on other parts of pixels
  assert.ok(back < way / 4, `${back} of ${way}`);
});

test('play goes through the steps by itself', async () => {
  await page.click('#play');
  await page.waitForFunction(() => Number(document.getElementById('step').value) === 2);
  await page.click('#play');
  assert.strictEqual(await page.textContent('#play'), 'Play');
});

test('scanners can be shown, and the view widens to hold them', async () => {
  const before = await stage();
  await page.check('#scanners');
  const now = await stage();
  assert.ok(now.lit > 0 && now.lit < before.lit, `${before.lit} to ${now.lit}`);
  await page.uncheck('#scanners');
});

test('mouse and keyboard turn, shift and zoom; Home goes back', async () => {
  await page.check('input[name=colour][value=deviation]');
  await page.click('button[data-view=oblique]');
  const home = await stage();
  const box = await page.locator('#canvas').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2 + 30, {steps: 4});
  await page.mouse.up();
  let before = await stage();
  assert.ok(await change(home, before) > 0.02);
  await page.focus('#canvas');
  for (const key of ['ArrowLeft', 'ArrowUp', 'Shift+ArrowRight', '+', '-']) {
    await page.keyboard.press(key);
    const now = await stage();
    assert.ok(await change(before, now) > 0.005, key);
    before = now;
  }
  await page.keyboard.press('Home');
  await page.evaluate(() => document.activeElement.blur());  // its outline is no part of the view
  assert.ok(await change(home, await stage()) < 0.001);
});

test('all controls can be reached by the tabulator', async () => {
  await page.evaluate(() => document.activeElement.blur());
  await page.focus('.skip');
  const reached = new Set();
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement.id ||
                                          document.activeElement.name ||
                                          document.activeElement.dataset.view));
  }
  for (const name of ['colour', 'scanners', 'pins', 'front', 'oblique', 'play', 'step', 'canvas'])
    assert.ok(reached.has(name), `${name} of ${[...reached]}`);
});

test('the points are at most 100,000 and the worst deviation is among them', async () => {
  const found = await page.evaluate(async () => {
    const data = JSON.parse(document.getElementById('scene').textContent);
    const surface = await unpackedPoints(data.surface);
    const step = data.surface.channels.find(channel => channel.name === 'deviation').step;
    const all = data.surface.count + data.scans.reduce((sum, one) => sum + one.points.count, 0);
    const most = surface.deviation.reduce((a, b) => Math.abs(b) > Math.abs(a) ? b : a, 0);
    return {all, most, step};
  });
  assert.ok(found.all <= 100000 && found.all > 5000, `${found.all}`);
  const worst = twin.deviation.call_outs[0].deviation_m;
  // Half a step, and the rounding of a float.
  assert.ok(Math.abs(found.most - worst) <= 0.5 * found.step + 1e-7 * Math.abs(worst));
});

test('the page shows the numbers of its twin', async () => {
  const shown = new Set(await page.$$eval('data', all => all.map(one => Number(one.value))));
  for (const measurement of twin.measurements)
    if (measurement.value !== null) assert.ok(shown.has(measurement.value), measurement.name);
  for (const value of Object.values(twin.deviation.statistics))
    if (!Number.isInteger(value)) assert.ok(shown.has(value), `${value}`);
});

test('text stands out against its background, light and dark', async () => {
  for (const colorScheme of ['light', 'dark']) {
    await page.emulateMedia({colorScheme});
    const ratios = await page.evaluate(() => {
      const levels = text => text.match(/[0-9.]+/g).map(Number);
      const luminance = ([r, g, b]) => [r, g, b].map(v => v / 255)
        .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
        .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
      const behind = element => {
        for (let e = element; e; e = e.parentElement) {
          const tone = levels(getComputedStyle(e).backgroundColor);
          if (tone.length < 4 || tone[3] > 0) return tone;
        }
        return [255, 255, 255];
      };
      const picked = 'h1, h2, p, a, td, th, caption, figcaption, button, legend, label, dt, dd, .tag';
      return [...document.querySelectorAll(picked)].map(element => {
        const a = luminance(levels(getComputedStyle(element).color));
        const b = luminance(behind(element));
        return {ratio: (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05),
                text: element.outerHTML.slice(0, 80)};
      });
    });
    assert.ok(ratios.length > 100);
    for (const {ratio, text} of ratios)  // WCAG 2.1, 1.4.3, AA
      assert.ok(ratio >= 4.5, `${colorScheme} ${ratio} ${text}`);
  }
  await page.emulateMedia({colorScheme: 'light'});
});

test('a narrow screen needs no scrolling sideways', async () => {
  const [narrow] = await open(browser, {viewport: {width: 360, height: 700}});
  await ready(narrow);
  assert.strictEqual(await narrow.evaluate(() => document.documentElement.scrollWidth), 360);
  await narrow.context().close();
});

test('on paper the picture stands in and every part is there', async () => {
  await page.emulateMedia({media: 'print'});
  assert.strictEqual(await page.isVisible('#canvas'), false);
  assert.strictEqual(await page.isVisible('#stage img'), true);
  assert.strictEqual(await page.isVisible('nav'), false);
  // A4 less 1 cm on either side; what is wider would be cut.
  await page.setViewportSize({width: 718, height: 700});
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 718);
  await page.setViewportSize({width: 800, height: 700});
  const pdf = (await page.pdf({format: 'A4'})).toString('latin1');
  assert.ok(pdf.startsWith('%PDF'));
  const pages = pdf.match(/\/Type\s*\/Page\b/g) || [];
  assert.ok(pages.length >= 3 && pages.length <= 40, `${pages.length} pages`);
  await page.emulateMedia({media: 'screen'});
});

async function standsIn(options, state) {
  const without = await launch(withoutWebGl);
  try {
    const [plain, notes] = await open(without, options);
    if (state) {
      await ready(plain);
      assert.strictEqual(await plain.evaluate(() => document.body.dataset.viewer), state);
    }
    assert.strictEqual(await plain.isVisible('#canvas'), false);
    const shown = await structureOf(blank, await plain.locator('#stage').screenshot());
    assert.ok(shown.lit > 0.05 && shown.colours > 50, JSON.stringify(shown));
    assert.deepStrictEqual(notes.requests, [pathToFileURL(report).href]);
    return await plain.textContent('#viewer-state');
  } finally {
    await without.close();
  }
}

test('without WebGL the picture stands in and says so', async () => {
  assert.match(await standsIn({}, 'no-webgl'), /no WebGL/);
});

test('without scripts the picture stands in', async () => {
  assert.match(await standsIn({javaScriptEnabled: false}, ''), /Without WebGL and scripts/);
});
