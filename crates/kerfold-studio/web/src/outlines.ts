// Outlines of D-forms: drawings that are dropped, and one that is drawn by hand.

import { h, s } from "./dom";

type Point = [number, number];

/** Whether a file may hold the outline of a piece. */
export const isOutline = (name: string) => /\.(svg|dxf|csv)$/i.test(name);

/** The recipe of a D-form of these outlines: of one the same twice, a quarter turned, as D-forms began. */
export function outlineRecipe(files: string[]) {
  const [first, second = first] = files.map((name) => JSON.stringify(name));
  return `[[step]]\ndform = "outlines"\noutlines = [${first}, ${second}]\nstart = 0.25\n`;
}

/** Points of an outline as the lines of a CSV file. */
export const outlineText = (points: Point[]) =>
  ["# drawn in the studio: x,y in mm", ...points.map(([x, y]) => `${x.toFixed(4)},${y.toFixed(4)}`), ""].join("\n");

/** How many points an outline that is drawn gets, and how many waves of it are kept. */
const POINTS = 240;
const WAVES = 5;

/**
 * A closed curve near points that a hand drew: spread evenly, then made smooth by leaving out all but its long
 * waves. The larger side of its box is as long as asked; y is up. Null where the hand went nowhere.
 */
export function smoothOutline(drawn: Point[], extent: number): Point[] | null {
  const lengths = [0];
  const at = (i: number) => drawn[i % drawn.length];
  for (let i = 0; i < drawn.length; i++) lengths.push(lengths[i] + Math.hypot(at(i + 1)[0] - at(i)[0], at(i + 1)[1] - at(i)[1]));
  const total = lengths[drawn.length];
  if (drawn.length < 3 || !(total > 0)) return null;
  let i = 0;
  const even = Array.from({ length: POINTS }, (_, k): Point => {
    const wanted = (total * k) / POINTS;
    while (lengths[i + 1] < wanted) i += 1;
    const share = (wanted - lengths[i]) / (lengths[i + 1] - lengths[i] || 1);
    return [0, 1].map((axis) => at(i)[axis] + share * (at(i + 1)[axis] - at(i)[axis])) as Point;
  });
  const wave = (k: number, n: number) => [Math.cos((2 * Math.PI * k * n) / POINTS), Math.sin((2 * Math.PI * k * n) / POINTS)];
  const smooth = even.map((): Point => [0, 0]);
  for (let n = 0; n <= WAVES; n++) {
    for (const axis of [0, 1]) {
      let [c, d] = [0, 0];
      even.forEach((p, k) => {
        const [cos, sin] = wave(k, n);
        c += p[axis] * cos;
        d += p[axis] * sin;
      });
      const weight = (n ? 2 : 1) / POINTS;
      smooth.forEach((p, k) => {
        const [cos, sin] = wave(k, n);
        p[axis] += weight * (c * cos + d * sin);
      });
    }
  }
  const box = [0, 1].map((axis) => [Math.min(...smooth.map((p) => p[axis])), Math.max(...smooth.map((p) => p[axis]))]);
  const size = Math.max(...box.map(([low, high]) => high - low));
  if (!(size > 0)) return null;
  return smooth.map(([x, y]): Point => [((x - box[0][0]) * extent) / size, ((box[1][1] - y) * extent) / size]);
}

/** Lets an outline be drawn in a dialog; `done` gets its points in mm, and says whether it is content. */
export function drawOutline(dialog: HTMLDialogElement, done: (points: Point[]) => Promise<void>) {
  const [width, height] = [380, 280];
  const trace = s("path", { class: "trace" });
  const curve = s("path", { class: "curve" });
  const paper = s("svg", { class: "paper", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "Draw an outline here" }, trace, curve);
  const extent = h("input", { type: "number", id: "outline-size", value: "180", min: "1", "aria-label": "Largest extent in mm" });
  const use = h("button", { class: "main", type: "submit", disabled: true }, "Use");
  const fault = h("p", { class: "fault", role: "alert" });
  let drawn: Point[] = [];
  const path = (points: Point[], end: string) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("") + end;
  const place = (event: PointerEvent): Point => {
    const box = paper.getBoundingClientRect();
    return [((event.clientX - box.left) * width) / box.width, ((event.clientY - box.top) * height) / box.height];
  };
  const show = () => {
    trace.setAttribute("d", drawn.length ? path(drawn, "") : "");
    const smooth = smoothOutline(drawn, 1);
    use.disabled = !smooth;
    if (!smooth) return curve.setAttribute("d", "");
    // Where the hand went: the smooth curve has its own size.
    const box = [0, 1].map((axis) => [Math.min(...drawn.map((p) => p[axis])), Math.max(...drawn.map((p) => p[axis]))]);
    const size = Math.max(...box.map(([low, high]) => high - low));
    curve.setAttribute("d", path(smooth.map(([x, y]): Point => [box[0][0] + x * size, box[1][1] - y * size]), "Z"));
  };
  paper.addEventListener("pointerdown", (event) => {
    paper.setPointerCapture(event.pointerId);
    drawn = [place(event)];
    show();
  });
  paper.addEventListener("pointermove", (event) => {
    if (!paper.hasPointerCapture(event.pointerId)) return;
    drawn.push(place(event));
    show();
  });
  const box = h("form", { method: "dialog" },
    h("h2", {}, "Draw an outline"), paper,
    h("p", {}, "Two pieces of this shape are joined, one a quarter turned. Draw it in one go; it is closed and made smooth."),
    h("label", {}, "largest extent in mm ", extent), fault,
    h("div", { class: "buttons" }, h("button", { type: "button", onclick: () => dialog.close() }, "Cancel"), use));
  box.addEventListener("submit", (event) => {
    event.preventDefault();
    const points = smoothOutline(drawn, Number(extent.value));
    if (points && Number(extent.value) > 0) void done(points);
    else fault.textContent = "The extent has to be a number above 0.";
  });
  dialog.replaceChildren(box);
  dialog.showModal();
}
