// A studio, a browser, and hands for it: clicks and drags on what is drawn.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";

const target = resolve(import.meta.dirname, "../../..", process.env.CARGO_TARGET_DIR ?? "target");
const built = join(target, process.env.KERFOLD_PROFILE ?? "debug");
export const kerfold = join(built, "kerfold");
const studioProgram = join(built, "kerfold-studio");

export const folder = (name) => mkdtempSync(join(tmpdir(), `kerfold-studio-${name}-`));

/** A studio in a folder; `address` is for a browser. */
export async function studio(where, args = []) {
  const page = process.env.KERFOLD_STUDIO_TEST_PAGE;
  const more = page ? ["--page", page] : [];
  const child = spawn(studioProgram, ["--no-open", ...more, ...args], { cwd: where });
  let said = "";
  child.stderr.on("data", (text) => process.stderr.write(text));
  const address = await new Promise((done, fail) => {
    child.stdout.on("data", (text) => {
      said += text;
      const found = /http:\S+/.exec(said);
      if (found) done(found[0]);
    });
    child.on("exit", (code) => fail(new Error(`the studio ended with ${code}`)));
  });
  return { address, stop: () => child.kill("SIGINT") };
}

export async function browser() {
  const data = folder("profile");
  const context = await chromium.launchPersistentContext(data, {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    viewport: { width: 1280, height: 800 },
    args: [
      "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
      "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    ],
  });
  return {
    context,
    async close() {
      await context.close();
      rmSync(data, { recursive: true, force: true });
    },
  };
}

/** A page of the studio that is ready; faults of its scripts are faults of the test. */
export async function open(context, address) {
  const page = await context.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("console", (message) => {
    // A refusal that the page shows is no fault of a script.
    if (message.type() === "error" && !message.text().includes("status of")) faults.push(message.text());
  });
  await page.goto(address);
  await page.waitForSelector("body[data-ready=true]", { timeout: 60000 });
  return { page, faults };
}

/** Waits until the page shows pieces of the recipe as it is now. */
export const settled = (page) =>
  page.waitForFunction(() => {
    const { app } = window.studio;
    return app.pending === 0 && app.recipe.steps.length > 0 && app.model !== null && app.result?.revision === app.recipe.revision;
  }, undefined, { timeout: 120000 });

/** Where an element is drawn; throws when nothing of it can be seen. */
export const where = (page, kind, id) =>
  page.evaluate(([kind, id]) => window.studio.where(kind, id), [kind, id]);

/** Elements whose middles can be seen. */
export const seen = (page, kind) =>
  page.evaluate((kind) => {
    const ids = [...window.studio.app.model.ids(kind)];
    return ids.filter((id) => window.studio.where(kind, id)?.seen);
  }, kind);

/** Drags a slider to a share of its way with the mouse. */
export async function drag(page, slider, share, steps = 12) {
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  const [low, high, now] = await slider.evaluate((e) => [+e.min, +e.max, +e.value]);
  const at = (t) => box.x + 8 + t * (box.width - 16);
  const y = box.y + box.height / 2;
  await page.mouse.move(at((now - low) / (high - low)), y);
  await page.mouse.down();
  await page.mouse.move(at(share), y, { steps });
  await page.mouse.up();
}

/** Puts a step to the recipe by its name in the list. */
export async function add(page, title) {
  await page.selectOption("#add", title);
  await page.click("#add-step");
}
