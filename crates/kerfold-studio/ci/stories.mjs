// The three stories of the studio, with a real browser: what is clicked is what is drawn, and what
// is written is what the command line writes, byte for byte.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test, { after, before } from "node:test";
import { add, browser, drag, folder, kerfold, open, seen, settled, studio, where } from "./browser.mjs";

let chrome;
before(async () => (chrome = await browser()));
after(() => chrome.close());

/** Runs the recipe that was exported in another folder and compares all files. */
function compare(work, recipe, out, others = []) {
  const cli = folder("cli");
  for (const file of [recipe, ...others]) copyFileSync(join(work, file), join(cli, file));
  const ran = spawnSync(kerfold, ["run", recipe, "-o", out], { cwd: cli, encoding: "utf8" });
  assert.ok(ran.status === 0 || ran.status === 1, ran.stderr);
  const ours = readdirSync(join(work, out)).sort();
  assert.deepEqual(ours, readdirSync(join(cli, out)).sort());
  assert.ok(ours.includes("sheet-01.svg"), ours.join(" "));
  for (const file of ours) {
    const same = readFileSync(join(work, out, file)).equals(readFileSync(join(cli, out, file)));
    assert.ok(same, `${file} differs from that of the command line`);
  }
  rmSync(cli, { recursive: true });
}

async function exported(page, file) {
  await page.click("#export");
  await page.fill("#export-file", file);
  await page.fill("#export-folder", "made");
  await page.click("dialog button.main");
  await page.waitForFunction(() => document.querySelector("#status").textContent.includes("files into"), undefined, { timeout: 120000 });
}

async function story(name, files, tell) {
  const work = folder(name);
  for (const [file, text] of Object.entries(files)) writeFileSync(join(work, file), text);
  const running = await studio(work);
  const { page, faults } = await open(chrome.context, running.address);
  try {
    await tell(page, work);
    assert.deepEqual(faults, []);
  } catch (error) {
    mkdirSync(join(import.meta.dirname, "out"), { recursive: true });
    await page.screenshot({ path: join(import.meta.dirname, "out", `${name}.png`) });
    console.error(await page.textContent("#status"));
    throw error;
  } finally {
    await page.close();
    running.stop();
    rmSync(work, { recursive: true, force: true });
  }
}

test("1: a D-form from nothing", () => story("dform", {}, async (page, work) => {
  await page.click("[data-solid=dodecahedron]");
  await settled(page);
  assert.equal(await page.evaluate(() => window.studio.app.model.faces.length), 12);
  await page.click("#tab-seams");
  await page.waitForSelector(".seam-row");
  assert.ok((await page.locator(".seam-row").count()) >= 2);
  await page.locator(".seam-row").first().click();
  await settled(page);
  const faces = await page.evaluate(() => window.studio.app.model.faces.length);
  assert.ok(faces > 100, `${faces} faces`);
  // The offset is dragged, and body and sheet follow.
  await page.click("#tab-sheet");
  await page.locator(".steps .head").nth(1).click();
  const before = await page.evaluate(() => window.studio.app.recipe.text);
  await drag(page, page.locator(".steps .field[data-key=offset] input[type=range]"), 0.12);
  await settled(page);
  assert.notEqual(await page.evaluate(() => window.studio.app.recipe.text), before);
  await page.waitForSelector(".sheet svg");
  // One drag is one change.
  await page.locator("#canvas").focus();
  await page.keyboard.press("Control+z");
  await settled(page);
  assert.equal(await page.evaluate(() => window.studio.app.recipe.text), before);
  await page.keyboard.press("Control+Shift+z");
  await settled(page);
  await add(page, "unfold");
  await settled(page);
  await exported(page, "d-form.toml");
  compare(work, "d-form.toml", "made");
  // Nothing is lost on reload.
  const text = await page.evaluate(() => window.studio.app.recipe.text);
  await page.reload();
  await page.waitForSelector("body[data-ready=true]");
  assert.equal(await page.evaluate(() => window.studio.app.recipe.text), text);
}));

test("1 again, by the keyboard alone", () => story("keys", {}, async (page, work) => {
  const press = (key) => page.keyboard.press(key);
  const focus = async (test, most = 60) => {
    for (let i = 0; i < most; i++) {
      if (await page.evaluate((test) => document.activeElement?.matches(test), test)) return;
      await press("Tab");
    }
    assert.fail(`${test} is not reached by the keyboard`);
  };
  await focus("[data-solid=cube]");
  await press("Enter");
  await settled(page);
  await focus("[role=tab][aria-selected=true]");
  await press("ArrowRight");
  await press("ArrowRight");
  await page.waitForSelector(".seam-row");
  await focus(".seam-row");
  await press("Enter");
  await settled(page);
  assert.equal(await page.evaluate(() => window.studio.app.recipe.steps.length), 2);
  await focus(".steps li:nth-child(2) .head", 120);
  await press("Enter");
  await focus(".steps .field[data-key=offset] input[type=range]");
  await press("ArrowLeft");
  await press("ArrowLeft");
  await settled(page);
  await focus("#add", 120);
  // A native list opens by a letter.
  await page.keyboard.type("unfold");
  await focus("#add-step");
  await press("Enter");
  await settled(page);
  assert.equal(await page.evaluate(() => window.studio.app.recipe.steps.length), 3);
  await focus("#export", 120);
  await press("Enter");
  await page.fill("#export-folder", "made");
  await press("Enter");
  await page.waitForFunction(() => document.querySelector("#status").textContent.includes("files into"), undefined, { timeout: 120000 });
  compare(work, "recipe.toml", "made");
}));

test("2: a sculptor marks, looks, and cuts", () => story("sculptor", {}, async (page, work) => {
  await page.click("[data-solid=cube]");
  await settled(page);
  const app = (expression) => page.evaluate((e) => new Function("app", `return ${e}`)(window.studio.app), expression);
  // Only what can be seen is picked: a click where a hidden edge is drawn marks no hidden edge.
  const visible = await seen(page, "edge");
  assert.equal(visible.length, 9);
  const hidden = [...Array(12).keys()].find((id) => !visible.includes(id));
  const behind = await where(page, "edge", hidden);
  await page.mouse.click(behind.x, behind.y);
  assert.ok(!(await app("[...app.marked]")).includes(hidden));
  await page.keyboard.press("Escape");
  await page.click("#xray");
  await page.mouse.click(behind.x, behind.y);
  assert.ok((await app("[...app.marked]")).length === 1);
  await page.click("#xray");
  await page.keyboard.press("Escape");
  // One edge by a click; the text says which.
  const one = await where(page, "edge", visible[0]);
  await page.mouse.click(one.x, one.y);
  assert.deepEqual(await app("[...app.marked]"), [visible[0]]);
  assert.equal(await page.inputValue("#selection"), String(visible[0]));
  // All in its direction by a double click.
  await page.mouse.dblclick(one.x, one.y);
  await page.waitForFunction(() => window.studio.app.marked.size === 4);
  assert.match(await page.inputValue("#selection"), /^along=/);
  // A text marks, too.
  await page.fill("#selection", "along=x | along=z");
  await page.press("#selection", "Enter");
  await page.waitForFunction(() => window.studio.app.marked.size === 8);
  // By symmetry.
  await page.keyboard.down("Alt");
  await page.mouse.click(one.x, one.y);
  await page.keyboard.up("Alt");
  await page.waitForFunction(() => window.studio.app.marked.size === 12);
  // By a box around all of it: what can be seen.
  await page.locator("#canvas").focus();
  await page.keyboard.press("Escape");
  const canvas = await page.locator("#canvas").boundingBox();
  await page.keyboard.down("Shift");
  await page.mouse.move(canvas.x + 6, canvas.y + 60);
  await page.mouse.down();
  await page.mouse.move(canvas.x + canvas.width - 20, canvas.y + canvas.height - 12, { steps: 5 });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  assert.equal((await app("[...app.marked]")).length, 9);
  // The plane and the cap are seen before anything is cut, red where cuts meet.
  await page.fill("#selection", "along=z");
  await page.press("#selection", "Enter");
  await page.waitForFunction(() => window.studio.app.preview?.told.cut?.overcut.length === 0);
  assert.equal(await app("app.recipe.steps.length"), 1);
  const slider = page.locator(".cutting .field[data-key=offset] input[type=range]");
  await drag(page, slider, 0.3);
  await page.waitForFunction(() => window.studio.app.preview?.told.cut?.overcut.length === 4);
  assert.ok(await page.locator(".cutting.overcut").count());
  await page.waitForSelector(".limit");
  assert.match(await page.textContent(".limit"), /0\.(49|50)/);
  await drag(page, slider, 0.1);
  await page.waitForFunction(() => window.studio.app.preview?.told.cut?.overcut.length === 0);
  // Rolled instead: the keys came from the schema, and a radius that is typed gets a slider.
  const field = (key) => page.locator(`.cutting .field[data-key=${key}]`);
  await field("roll").locator("input").fill("20mm");
  await field("roll").locator("input").press("Tab");
  await page.waitForFunction(() => window.studio.app.preview?.made("face").length === 36);
  // The largest radius at which no rolls meet is looked for, too.
  await page.waitForFunction(() => window.studio.app.limit?.key === "roll");
  assert.ok((await app("app.limit.value")) > 20);
  assert.equal(await field("roll").locator("input[type=range]").count(), 1);
  // A typed number counts as well, and takes the roll's place.
  const typed = page.locator(".cutting .field[data-key=offset] input[type=text]");
  await typed.fill("0.2");
  await typed.press("Tab");
  await page.locator("#canvas").focus();
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.studio.app.recipe.steps.length === 2);
  await page.waitForFunction(() => window.studio.app.selection === "strip");
  assert.equal(await app("app.marked.size"), 8);
  await settled(page);
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.studio.app.recipe.steps.length === 3);
  await settled(page);
  // Hover on a seam of a piece lights its partner and the edge of the model.
  await page.click("#tab-pieces");
  const grip = page.locator(".pieces line.grip").first();
  await grip.dispatchEvent("pointermove", { bubbles: true });
  assert.ok((await page.locator(".pieces line.lit").count()) >= 2);
  assert.equal(await app("app.hover.kind"), "edge");
  await add(page, "unfold");
  const pieces = page.locator(".steps .field[data-key=unfold] input");
  await pieces.fill("one");
  await pieces.press("Tab");
  await page.waitForFunction(() => window.studio.app.recipe.text.includes('unfold = "one"'));
  await settled(page);
  await exported(page, "column.toml");
  compare(work, "column.toml", "made");
}));

test("3: an architect drops a mesh", async () => {
  // A translation surface: its quads are planar, but for a fifth of a millimetre at one node; four
  // members meet at each.
  const [n, lines] = [6, []];
  for (let i = 0; i <= n; i++) for (let j = 0; j <= n; j++) lines.push(`v ${i * 1000} ${j * 1000} ${(200 * Math.sin(i) + 150 * Math.cos(0.7 * j) + (i === 2 && j === 3 ? 0.2 : 0)).toFixed(6)}`);
  for (let i = 0; i < n; i++) for (let j = 0; j < n; j++) {
    const k = i * (n + 1) + j + 1;
    lines.push(`f ${k} ${k + n + 1} ${k + n + 2} ${k + 1}`);
  }
  const obj = lines.join("\n") + "\n";
  await story("architect", {}, async (page, work) => {
    const data = await page.evaluateHandle((text) => {
      const data = new DataTransfer();
      data.items.add(new File([text], "facade.obj"));
      return data;
    }, obj);
    await page.dispatchEvent("body", "drop", { dataTransfer: data });
    await page.waitForFunction(() => window.studio.app.model?.faces.length === 36);
    await settled(page);
    await page.selectOption("#colour", "planarity");
    assert.match(await page.textContent("#legend"), /mm from planar/);
    await page.selectOption("#colour", "valence");
    assert.match(await page.textContent("#legend"), /more at some corner/);
    await add(page, "check");
    await page.waitForFunction(() => window.studio.app.recipe.steps.length === 2);
    await settled(page);
    await page.click("#tab-report");
    await page.waitForSelector(".verdict");
    assert.doesNotMatch(await page.textContent(".results"), /finding/);
    // Lists and choices of the form are made from the schema.
    const field = (key) => page.locator(`.steps .field[data-key=${key}]`);
    await field("check").locator("select").selectOption("plywood");
    await page.waitForFunction(() => window.studio.app.recipe.text.includes("plywood"));
    await field("require").locator("input").fill("valence3, closed");
    await field("require").locator("input").press("Tab");
    await page.waitForFunction(() => window.studio.app.recipe.text.includes("valence3"));
    await settled(page);
    assert.match(await page.textContent(".results"), /\d+ findings/);
    // What cannot be is told under its field, with its code, and changes nothing.
    await field("require").locator("input").fill("valence4");
    await field("require").locator("input").press("Tab");
    await page.waitForSelector(".field[data-key=require] .fault:not([hidden])");
    assert.match(await page.textContent(".field[data-key=require] .fault"), /\(E705\)/);
    assert.ok(await page.evaluate(() => window.studio.app.recipe.text.includes("valence3")));
    await add(page, "unfold");
    await page.waitForFunction(() => window.studio.app.recipe.steps.length === 3);
    const sheet = page.locator(".steps .field[data-key=sheet] input");
    await sheet.fill("8000x8000");
    await sheet.press("Tab");
    await settled(page);
    await exported(page, "facade.toml");
    compare(work, "facade.toml", "made", ["facade.obj"]);
  });
});

test("a D-form of an outline that is drawn, and of two that are dropped", async () => {
  await story("outlines", {}, async (page, work) => {
    await page.click("#draw-outline");
    const paper = await page.locator("dialog .paper").boundingBox();
    const at = (share) => {
      const angle = 2 * Math.PI * share;
      return [paper.x + paper.width / 2 + 130 * Math.cos(angle), paper.y + paper.height / 2 + 75 * Math.sin(angle)];
    };
    assert.ok(await page.locator("dialog button.main").isDisabled());
    await page.mouse.move(...at(0));
    await page.mouse.down();
    for (let k = 1; k <= 40; k++) await page.mouse.move(...at(k / 41));
    await page.mouse.up();
    await page.fill("#outline-size", "200");
    await page.click("dialog button.main");
    await page.waitForFunction(() => window.studio.app.recipe.text.includes("outline-1.csv"));
    await page.waitForFunction(() => window.studio.app.model?.faces.length > 100, undefined, { timeout: 60000 });
    await settled(page);
    const lines = readFileSync(join(work, "outline-1.csv"), "utf8").split("\n").filter((line) => /^[\d-]/.test(line));
    const points = lines.map((line) => line.split(",").map(Number));
    const extent = (axis) => Math.max(...points.map((p) => p[axis])) - Math.min(...points.map((p) => p[axis]));
    assert.equal(points.length, 240);
    assert.ok(Math.abs(extent(0) - 200) < 1e-3 && Math.abs(extent(1) / 200 - 75 / 130) < 0.05, `${extent(0)} x ${extent(1)}`);
    await exported(page, "drawn.toml");
    compare(work, "drawn.toml", "made", ["outline-1.csv"]);
    // Two drawings, in the order of their names.
    const circle = (r) => `<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="200mm" viewBox="0 0 200 200"><ellipse cx="100" cy="100" rx="${r}" ry="60"/></svg>`;
    const data = await page.evaluateHandle((texts) => {
      const data = new DataTransfer();
      texts.forEach((text, i) => data.items.add(new File([text], `${"ba"[i]}.svg`)));
      return data;
    }, [circle(60), circle(80)]);
    await page.dispatchEvent("body", "drop", { dataTransfer: data });
    await page.waitForFunction(() => window.studio.app.recipe.text.includes('["a.svg", "b.svg"]'));
    await page.waitForFunction(() => window.studio.app.model?.faces.length > 100, undefined, { timeout: 60000 });
    await settled(page);
  });
});

test("axe finds no serious fault", async () => {
  const axe = readFileSync(join(import.meta.dirname, "node_modules/axe-core/axe.min.js"), "utf8");
  await story("axe", {}, async (page) => {
    const look = async (what) => {
      // The page allows no scripts of others; the inspector may run its own.
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => window.axe.run());
      const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact));
      assert.deepEqual(serious.map((v) => `${what}: ${v.id}: ${v.nodes.map((n) => n.html.slice(0, 120)).join(" | ")}`), []);
    };
    await look("welcome");
    await page.click("[data-solid=cube]");
    await settled(page);
    await page.fill("#selection", "all");
    await page.press("#selection", "Enter");
    for (const tab of ["pieces", "sheet", "report", "seams"]) {
      await page.click(`#tab-${tab}`);
      await page.waitForTimeout(500);
      await look(tab);
    }
    await page.click("#theme");
    // Colours change over a moment.
    await page.waitForTimeout(500);
    await look("the other theme");
    await page.click("#export");
    await look("export");
  });
});
