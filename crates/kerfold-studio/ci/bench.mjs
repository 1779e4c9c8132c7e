// How fast the studio feels, measured in the browser and printed: the speeds of the design, for a
// model of 2 000 faces. The numbers are those of the machine; a browser that draws without a
// graphics card is slow in drawing alone, so the parts are told apart.

import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { browser, folder, open, settled, studio } from "./browser.mjs";

const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1] ?? NaN;
const ms = (x) => `${x.toFixed(0)} ms`;
const chrome = await browser();
const say = (what, measured, wanted) => console.log(`${what.padEnd(58)} ${measured.padStart(9)}   wanted ${wanted}`);

async function withRecipe(name, text, measure) {
  const work = folder(name);
  writeFileSync(join(work, "recipe.toml"), text);
  const running = await studio(work, ["recipe.toml"]);
  const begin = performance.now();
  const { page } = await open(chrome.context, running.address);
  await page.waitForFunction(() => window.studio.app.model !== null, undefined, { timeout: 300000 });
  const first = performance.now() - begin;
  await measure(page, first);
  await page.close();
  running.stop();
}

await withRecipe("cube", '[[step]]\nsolid = "dodecahedron"\nsize = "180mm"\n', async (_, first) => {
  say("first picture after the page is asked for", ms(first), "1000 ms");
});

// A geodesic ball of 2 000 faces, 100 edges cut.
const ball = '[[step]]\nsolid = "geodesic-10"\nsize = "300mm"\n';
await withRecipe("ball", ball, async (page) => {
  const faces = await page.evaluate(() => window.studio.app.model.faces.length);
  const parts = await page.evaluate(async () => {
    const { app } = window.studio;
    // Every seventh edge or so: 100 that have no corner in common.
    const used = new Set();
    const ids = [];
    for (const [place, id] of app.model.edges.entries()) {
      const ends = [...app.model.ends.subarray(2 * place, 2 * place + 2)];
      if (ids.length < 100 && !ends.some((v) => used.has(v))) {
        ids.push(id);
        ends.forEach((v) => used.add(v));
      }
    }
    app.setMarks(ids, ids.join(","));
    await app.look();
    const ask = [];
    const path = app.path("/preview");
    const token = new URLSearchParams(location.hash.slice(1)).get("token");
    for (let i = 0; i < 25; i++) {
      const begin = performance.now();
      const step = app.cut.map(([k, v]) => [k, k === "offset" ? 0.1 + i / 200 : v]);
      const answer = await fetch(path, {
        method: "POST", headers: { "x-kerfold-token": token, "content-type": "application/json" },
        body: JSON.stringify({ steps: app.steps, step }),
      });
      await answer.arrayBuffer();
      ask.push(performance.now() - begin);
    }
    app.frames.length = 0;
    for (let i = 0; i < 25; i++) await app.setCutting("offset", 0.1 + i / 200);
    const whole = [...app.frames];
    // Drawn when the pixels can be read, not when the card was told to draw.
    const gl = app.view.canvas.getContext("webgl2");
    const finish = (view) => {
      view.renderNow();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    };
    const draw = [];
    for (let i = 0; i < 15; i++) {
      const begin = performance.now();
      finish(app.view);
      draw.push(performance.now() - begin);
    }
    return { ask, whole, draw };
  });
  say(`a slider's frame: cut of 100 edges, ${faces} faces`, ms(median(parts.whole)), "50 ms");
  say("  of it the cut and the mesh to the page", ms(median(parts.ask)), "–");
  say("  of it drawing alone", ms(median(parts.draw)), "–");
});

// A D-form of about 2 000 faces to net and sheet.
const dform = `[[step]]
solid = "truncated-octahedron"
size = "300mm"

[[step]]
cut = "edge"
select = "hamiltonian"
offset = 0.3
repeat = 7
`;
await withRecipe("dform", dform, async (page) => {
  await settled(page);
  const faces = await page.evaluate(() => window.studio.app.model.faces.length);
  const times = [];
  for (let i = 0; i < 5; i++) {
    const begin = performance.now();
    await page.evaluate((offset) => window.studio.app.set(2, "offset", offset, null), 0.28 + i / 100);
    await settled(page);
    times.push(performance.now() - begin);
  }
  say(`net and sheet after a change, ${faces} faces`, ms(median(times)), "500 ms");
});

await withRecipe("large", '[[step]]\nsolid = "geodesic-71"\nsize = "300mm"\n', async (page) => {
  const large = await page.evaluate(() => {
    const { app } = window.studio;
    const canvas = app.view.canvas.getBoundingClientRect();
    const [x, y] = [canvas.left + canvas.width / 2, canvas.top + canvas.height / 2];
    app.view.pick("face", x, y);
    const time = (task) => {
      const begin = performance.now();
      for (let i = 0; i < 10; i++) task(i);
      return (performance.now() - begin) / 10;
    };
    const pick = time((i) => app.view.pick("edge", x + 9 * i, y));
    const gl = app.view.canvas.getContext("webgl2");
    const draw = time(() => {
      app.view.renderNow();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    });
    return { faces: app.model.faces.length, pick, draw };
  });
  say(`${large.faces} faces: picking an edge`, `${large.pick.toFixed(1)} ms`, "33 ms");
  say(`${large.faces} faces: drawing a picture`, ms(large.draw), "33 ms");
});

await chrome.close();
