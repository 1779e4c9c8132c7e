// The pictures of docs/images/studio: each screen, light and dark, in two sizes.

import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { browser, drag, folder, open, settled, studio, where } from "./browser.mjs";

const target = join(import.meta.dirname, "../../../docs/images/studio");
mkdirSync(target, { recursive: true });
const chrome = await browser();
const running = await studio(folder("pictures"));
const sizes = [[1280, 800], [1024, 768]];

async function shoot(page, name) {
  for (const theme of ["light", "dark"]) {
    await page.evaluate((theme) => {
      if (document.documentElement.dataset.theme !== theme) document.getElementById("theme").click();
    }, theme);
    for (const [width, height] of sizes) {
      await page.setViewportSize({ width, height });
      await page.waitForTimeout(250);
      await page.evaluate(() => window.studio.app.view.home());
      await page.waitForTimeout(350);
      await page.screenshot({ path: join(target, `${name}-${theme}-${width}.png`) });
    }
  }
  await page.setViewportSize({ width: 1280, height: 800 });
}

const { page } = await open(chrome.context, running.address);
await shoot(page, "welcome");
await page.click("[data-solid=dodecahedron]");
await settled(page);
await page.click("#tab-seams");
await page.waitForSelector(".seam-row");
await shoot(page, "seams");
await page.locator(".seam-row").first().click();
await settled(page);
await page.click("#tab-sheet");
await page.locator(".steps .head").nth(1).click();
await page.selectOption("#colour", "piece");
await settled(page);
await page.waitForSelector(".sheet svg");
await shoot(page, "d-form");
await page.click("#tab-pieces");
await page.locator("#closing").fill("3");
await page.waitForTimeout(1500);
await shoot(page, "closing");
await page.locator("#closing").fill("7");
await page.click("#tab-report");
await shoot(page, "report");
await page.close();

const second = await open(chrome.context, running.address);
const { page: cut } = second;
await cut.evaluate(() => sessionStorage.clear());
await cut.click("[data-solid=cube]");
await settled(cut);
await cut.selectOption("#colour", "plain");
const edge = await where(cut, "edge", 0);
await cut.mouse.dblclick(edge.x, edge.y);
await cut.waitForFunction(() => window.studio.app.preview !== null);
await cut.mouse.move(5, 300);
await settled(cut);
await cut.waitForTimeout(800);
await shoot(cut, "cutting");
await drag(cut, cut.locator(".cutting .field[data-key=offset] input[type=range]"), 0.3);
await cut.waitForFunction(() => window.studio.app.preview?.told.cut?.overcut.length > 0);
await cut.waitForTimeout(1500);
await shoot(cut, "overcut");
await cut.keyboard.press("Escape");
await cut.click("#export");
await shoot(cut, "export");
await chrome.close();
running.stop();
