// Pieces, sheets, report and seams, side by side with the model.

import type { App, Piece, SeamRow } from "./app";
import { byId, h, plural, s, short } from "./dom";
import type { Model } from "./model";

const TABS = ["Pieces", "Sheet", "Report", "Seams"] as const;
type Tab = (typeof TABS)[number];

export function right(app: App) {
  const pane = byId("right");
  let shown: Tab = "Sheet";
  const bar = h("div", { class: "tabs", role: "tablist", "aria-label": "Results" });
  const body = h("div", { class: "results", role: "tabpanel", tabindex: "0", id: "results" });
  const work = h("p", { class: "work", role: "status" });
  pane.append(bar, work, body);
  for (const tab of TABS) {
    bar.append(h("button", {
      role: "tab", id: `tab-${tab.toLowerCase()}`, "aria-controls": "results", "data-tab": tab, onclick: () => show(tab),
    }, tab));
  }
  bar.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    show(TABS[(TABS.indexOf(shown) + step + TABS.length) % TABS.length]);
    bar.querySelector<HTMLElement>("[aria-selected=true]")!.focus();
  });

  function show(tab: Tab) {
    shown = tab;
    draw();
  }

  function draw() {
    for (const button of bar.querySelectorAll<HTMLElement>("[role=tab]")) {
      const isShown = button.dataset.tab === shown;
      button.setAttribute("aria-selected", String(isShown));
      button.tabIndex = isShown ? 0 : -1;
    }
    body.setAttribute("aria-labelledby", `tab-${shown.toLowerCase()}`);
    body.dataset.tab = shown;
    if (shown === "Seams") return void drawSeams();
    const { result } = app;
    if (!result) return body.replaceChildren(h("p", { class: "empty" }, "Nothing yet: begin with a solid or a file."));
    if (shown === "Report") return body.replaceChildren(...report(app));
    if (!result.pieces || !result.layout) {
      const told = result.failure ? `${result.failure.message} (${result.failure.code})` : "no pieces";
      return body.replaceChildren(h("p", { class: "fault" }, told));
    }
    body.replaceChildren(...(shown === "Pieces" ? pieces(app) : sheets(app)));
    light();
  }

  // ---- hover: partners light up in all views -------------------------------------------------------

  body.addEventListener("pointermove", (event) => {
    const element = (event.target as Element).closest<SVGElement>("[data-face],[data-edge]");
    if (!element) return app.setHover(null);
    const edge = element.dataset.edge;
    app.setHover(edge !== undefined ? { kind: "edge", id: +edge } : { kind: "face", id: +element.dataset.face! });
  });
  body.addEventListener("pointerleave", () => app.setHover(null));

  function light() {
    for (const element of body.querySelectorAll(".lit")) element.classList.remove("lit");
    const { hover } = app;
    if (!hover || hover.kind === "vertex") return;
    for (const element of body.querySelectorAll(`[data-${hover.kind}="${hover.id}"]`)) element.classList.add("lit");
  }

  async function drawSeams() {
    if (!app.recipe.steps.length) return body.replaceChildren(h("p", { class: "empty" }, "Begin with a solid: each way to divide it will be shown here."));
    body.replaceChildren(h("p", { class: "empty" }, "Looking for the ways to divide the solid…"));
    try {
      const seams = await app.seams();
      if (!seams || shown !== "Seams") return;
      const first = app.recipe.steps[seams.steps];
      const taken = first?.[0][0] === "cut" ? first.find(([key]) => key === "select")?.[1] : undefined;
      const rows = seams.rows.map((row) => seamButton(row, seams.model, row.selection === taken, () => take(row, seams.steps)));
      const head = `${plural(rows.length, "way", "ways")} to divide the solid by closed seams; the coloured edges fold, the others are cut and joined.`;
      body.replaceChildren(h("p", {}, head), ...(seams.note ? [h("p", { class: "note" }, seams.note)] : []), h("div", { class: "seams" }, ...rows));
    } catch (error) {
      body.replaceChildren(h("p", { class: "fault" }, error instanceof Error ? error.message : String(error)));
    }
  }

  /** Takes a way to divide: its folds are cut, or those that are cut by now are changed. */
  async function take(row: SeamRow, steps: number) {
    const next = app.recipe.steps[steps];
    const isCut = next?.[0][0] === "cut" && next[0][1] === "edge";
    app.at = null;
    if (isCut) await app.set(steps + 1, "select", row.selection, null);
    else {
      const step = [["cut", "edge"], ["select", row.selection], ["offset", 0.3], ["repeat", 4]];
      await app.change("POST", "/steps", { step, at: steps + 1 });
    }
    await drawSeams();
  }

  app.on("result", () => shown !== "Seams" && draw());
  app.on("recipe", () => shown === "Seams" && !app.recipe.steps.length && draw());
  app.on("hover", light);
  app.on("work", () => (work.textContent = app.work));
  draw();
}

const points = (list: [number, number][]) => list.map(([x, y]) => `${x},${-y}`).join(" ");

function bounds(piece: Piece) {
  const xs = piece.outline.map((p) => p[0]);
  const ys = piece.outline.map((p) => -p[1]);
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  return { left, top, width: Math.max(...xs) - left || 1, height: Math.max(...ys) - top || 1 };
}

const edgeOf = (id: string) => String(+id.replace(/\D/g, ""));

function pieces(app: App): Node[] {
  const { pieces: net } = app.result!;
  const largest = Math.max(...net!.pieces.map((piece) => Math.max(bounds(piece).width, bounds(piece).height)));
  const about = `${plural(net!.pieces.length, "piece", "pieces")}, ${plural(net!.folds.length, "fold", "folds")}, ${plural(net!.seams.length, "seam", "seams")}; folded up again true to ${net!.proof.refold_mm.toExponential(0)} mm, ${plural(net!.proof.overlaps, "overlap", "overlaps")}`;
  const drawn = net!.pieces.slice(0, 200).map((piece) => {
    const { left, top, width, height } = bounds(piece);
    const m = 0.02 * largest;
    const share = Math.max(0.18, Math.max(width, height) / largest);
    const svg = s("svg", {
      viewBox: `${left - m} ${top - m} ${width + 2 * m} ${height + 2 * m}`, role: "img", "aria-label": `piece ${piece.id}`,
      style: `width:${100 * share * (width >= height ? 1 : width / height)}%`,
    });
    for (const face of piece.faces) svg.append(s("polygon", { class: "face", points: points(face.polygon), "data-face": face.face }));
    const line = (id: string, [a, b]: [[number, number], [number, number]], kind: string) =>
      svg.append(
        s("line", { class: kind, x1: a[0], y1: -a[1], x2: b[0], y2: -b[1], "data-edge": edgeOf(id) }),
        s("line", { class: "grip", x1: a[0], y1: -a[1], x2: b[0], y2: -b[1], "data-edge": edgeOf(id) }),
      );
    for (const fold of net!.folds) if (fold.piece === piece.id) line(fold.id, fold.segment, `fold ${fold.kind}`);
    for (const seam of net!.seams) for (const side of seam.sides) if (side.piece === piece.id) line(seam.id, side.segment, "seam");
    return h("figure", {}, svg, h("figcaption", {}, piece.id));
  });
  return [h("p", {}, about), h("div", { class: "pieces" }, ...drawn)];
}

function sheets(app: App): Node[] {
  const { layout, pieces: net, seconds } = app.result!;
  const time = seconds ? `, ${Math.round(seconds / 60)} min` : "";
  const about = `${plural(layout!.sheets.length, "sheet", "sheets")}, ${Math.round(100 * layout!.density)} % used, ${short(layout!.cut_length)} mm to cut, ${short(layout!.score_length)} mm to score${time}`;
  const drawn = layout!.sheets.slice(0, app.svgs.length).map((sheet, i) => {
    // The file itself, as it will be written.
    const parsed = new DOMParser().parseFromString(app.svgs[i], "image/svg+xml").documentElement as unknown as SVGSVGElement;
    const svg = document.importNode(parsed, true);
    svg.removeAttribute("width");
    svg.removeAttribute("height");
    // Several sheets have the same ids; on one page each may occur once.
    svg.querySelectorAll("[id]").forEach((e) => e.removeAttribute("id"));
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", `sheet ${sheet.id}, ${sheet.width} by ${sheet.height} mm`);
    const grips = s("g", { class: "grips" });
    for (const placed of sheet.placed) {
      const piece = net!.pieces.find((p) => p.id === placed.piece);
      const turn = (placed.rotation * Math.PI) / 180;
      const [c, d] = [Math.cos(turn), Math.sin(turn)];
      const place = ([x, y]: [number, number]) => [c * x - d * y + placed.x, sheet.height - (d * x + c * y + placed.y)];
      for (const face of piece?.faces ?? []) {
        grips.append(s("polygon", { "data-face": face.face, points: face.polygon.map((p) => place(p).join(",")).join(" ") }));
      }
      const line = (id: string, [a, b]: [[number, number], [number, number]]) => {
        const [p, q] = [place(a), place(b)];
        grips.append(s("line", { "data-edge": edgeOf(id), x1: p[0], y1: p[1], x2: q[0], y2: q[1] }));
      };
      for (const fold of net!.folds) if (fold.piece === placed.piece) line(fold.id, fold.segment);
      for (const seam of net!.seams) for (const side of seam.sides) if (side.piece === placed.piece) line(seam.id, side.segment);
    }
    svg.append(grips);
    return h("figure", { class: "sheet" }, svg, h("figcaption", {}, `${sheet.id} · ${sheet.width} × ${sheet.height} mm`));
  });
  const rest = layout!.sheets.length - drawn.length;
  return [h("p", {}, about), ...drawn, ...(rest > 0 ? [h("p", {}, `and ${plural(rest, "sheet", "sheets")} more in the export`)] : [])];
}

function report(app: App): Node[] {
  const { report: told, notes, unclean, panels, command, failure } = app.result!;
  const nodes: Node[] = [];
  const row = (name: string, value: string) => h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, value));
  if (told) {
    const { model, planarity, valence, findings, verdict } = told;
    nodes.push(
      h("p", { class: `verdict ${verdict}` }, `check: ${verdict}`),
      h("table", {},
        row("vertices, edges, faces", `${model.vertices}, ${model.edges}, ${model.faces}`),
        row("size", `${model.size_mm.map(short).join(" × ")} mm`),
        row("parts, genus, rims", `${model.components}, ${model.genus}, ${model.rims}`),
        row("worst planarity", `${short(planarity.max_mm)} mm, ${short(planarity.max_permille)} ‰`),
        row("edges at vertices", Object.entries(valence.histogram).map(([v, n]) => `${v}: ${n}`).join(", ")),
        row("convex", told.convex ? "yes" : "no"),
      ),
    );
    if (findings.length) {
      nodes.push(h("h3", {}, plural(findings.length, "finding", "findings")), h("ul", {}, ...findings.slice(0, 100).map((f: any) => {
        const item = h("li", { tabindex: "0" }, f.message ?? `${f.check}: ${f.element} ${f.id}, ${short(f.measured)} ${f.unit} (limit ${short(f.limit)})`);
        if (["vertex", "edge", "face"].includes(f.element)) {
          item.addEventListener("pointerenter", () => app.setHover({ kind: f.element, id: f.id }));
          item.addEventListener("focus", () => app.setHover({ kind: f.element, id: f.id }));
          item.addEventListener("pointerleave", () => app.setHover(null));
        }
        return item;
      })));
    }
  }
  if (failure) nodes.push(h("p", { class: "fault" }, `${failure.message} (${failure.code})`));
  if (panels) {
    nodes.push(h("h3", {}, "Panels"), h("table", { class: "list" },
      h("tr", {}, ...["panel", "group", "sides"].map((name) => h("th", { scope: "col" }, name))),
      ...(panels.panels as any[]).slice(0, 200).map((p) => h("tr", {}, h("td", {}, String(p.id ?? p.panel ?? "")), h("td", {}, String(p.group ?? "")), h("td", {}, String(p.sides ?? "")))),
    ));
  }
  const all = [...unclean, ...notes];
  if (all.length) nodes.push(h("h3", {}, "Notes"), h("ul", {}, ...all.map((note) => h("li", {}, note))));
  nodes.push(h("h3", {}, "The same in a terminal"), h("pre", {}, command), h("h3", {}, "Recipe"), h("pre", { id: "recipe-text" }, app.recipe.text));
  return nodes;
}

/** A small picture of a solid with its folds, seen as the model is at first. */
function seamButton(row: SeamRow, model: Model, isTaken: boolean, onclick: () => void) {
  const eye = [0.62, -0.86, 0.52];
  const length = Math.hypot(...eye);
  const [x, y, z] = eye.map((e) => e / length);
  const flat = Math.hypot(x, y);
  const right = [-y / flat, x / flat, 0];
  const up = [-x * z / flat, -y * z / flat, flat];
  const dot = (a: number[], b: number[]) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const folds = new Set(row.folds);
  const r = model.radius;
  const svg = s("svg", { viewBox: `${-0.72 * r} ${-0.72 * r} ${1.44 * r} ${1.44 * r}`, "aria-hidden": "true" });
  const depth = (place: number) => dot(model.vertex(model.ends[2 * place]), [x, y, z]) + dot(model.vertex(model.ends[2 * place + 1]), [x, y, z]);
  const order = Array.from(model.edges.keys()).sort((a, b) => depth(a) - depth(b));
  for (const place of order) {
    const [a, b] = [model.vertex(model.ends[2 * place]), model.vertex(model.ends[2 * place + 1])];
    svg.append(s("line", {
      x1: dot(a, right), y1: -dot(a, up), x2: dot(b, right), y2: -dot(b, up),
      class: `${folds.has(model.edges[place]) ? "fold" : "seam"} ${depth(place) < 0 ? "far" : ""}`,
    }));
  }
  const alike = row.orbit === null ? "" : `, ${row.orbit} alike`;
  return h("button", { class: "seam-row", "aria-pressed": String(isTaken), "data-selection": row.selection, onclick },
    svg, h("span", {}, plural(row.pieces, "piece", "pieces")), h("small", {}, `fold sum ${short(row.fold_sum)}${alike}`));
}
