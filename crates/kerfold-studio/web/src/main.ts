// The page: puts the panes together, and what the pointer and the keys do.

import "./style.css";
import * as api from "./api";
import { Refusal } from "./api";
import { App } from "./app";
import type { ColourBy } from "./colours";
import { byId, h } from "./dom";
import { left } from "./left";
import { type Element, idsText } from "./model";
import { drawOutline, isOutline, outlineRecipe, outlineText } from "./outlines";
import { right } from "./right";

const app = new App();

// ---- theme ------------------------------------------------------------------------------------------

const wanted = matchMedia("(prefers-color-scheme: dark)");
function theme(isDark: boolean) {
  document.documentElement.dataset.theme = isDark ? "dark" : "light";
  app.view.theme(isDark);
}
let chosen = localStorage.getItem("theme");
theme(chosen ? chosen === "dark" : wanted.matches);
wanted.addEventListener("change", () => !chosen && theme(wanted.matches));
byId("theme").addEventListener("click", () => {
  chosen = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  localStorage.setItem("theme", chosen);
  theme(chosen === "dark");
});

// ---- tools of the view --------------------------------------------------------------------------------

const COLOURS: [ColourBy, string][] = [
  ["plain", "no colour"], ["piece", "by piece"], ["planarity", "by planarity"], ["valence", "by valence"], ["fold", "by fold angle"], ["group", "by group"],
];
function tools() {
  const colour = h("select", { id: "colour", "aria-label": "Colour of the model" }, ...COLOURS.map(([by, text]) => h("option", { value: by }, text)));
  colour.addEventListener("change", () => {
    app.view.colourBy = colour.value as ColourBy;
    app.view.rebuild();
  });
  const xray = h("button", { id: "xray", "aria-pressed": "false", title: "See and mark hidden parts, too (X)" }, "X-ray");
  xray.addEventListener("click", () => {
    app.view.isXray = !app.view.isXray;
    xray.setAttribute("aria-pressed", String(app.view.isXray));
    app.view.rebuild();
  });
  const like = h("select", { id: "like", "aria-label": "What a double click marks", title: "What a double click marks" },
    ...[["direction", "2×: direction"], ["loop", "2×: loop"], ["strip", "2×: strip"], ["symmetric", "2×: symmetric"]].map(([how, text]) => h("option", { value: how }, text)));
  const none = h("button", { title: "Mark nothing (Esc)", onclick: () => app.setMarks([], "") }, "Clear marks");
  const home = h("button", { title: "See all of it (Home)", onclick: () => app.view.home() }, "View all");
  const picture = h("button", { title: "The picture as PNG", onclick: savePicture }, "PNG");
  byId("tools").append(colour, like, xray, none, home, picture);
  app.view.onlegend = ({ legend }) =>
    byId("legend").replaceChildren(...legend.map(({ colour, text }) => h("span", {}, h("i", { style: `background:${colour}` }), text)));
  return { xray, like };
}

async function savePicture() {
  const blob = await app.view.picture();
  if (blob) download(URL.createObjectURL(blob), "model.png");
}

function download(url: string, name: string) {
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

const { xray, like } = tools();

// ---- the closing film ----------------------------------------------------------------------------------

function film() {
  const box = byId("film");
  const range = h("input", { type: "range", id: "closing", min: 0, max: 7, step: 0.05, value: "7", "aria-label": "From the flat pieces to the closed model" });
  box.append(h("span", {}, "flat"), range, h("span", {}, "closed"));
  const show = api.newest(async () => {
    try {
      const isEnd = +range.value >= +range.max;
      app.view.showFilm(isEnd ? null : await app.film(+range.value));
    } catch (error) {
      app.refuse(error);
    }
  });
  range.addEventListener("input", () => void show());
  app.on("result", () => {
    box.hidden = !app.result?.pieces || Boolean(app.result.panels) || Boolean(app.result.failure);
    range.max = String(app.result?.closing_seconds ?? 7);
  });
  app.on("model", () => {
    range.value = range.max;
    app.view.showFilm(null);
  });
}
film();

// ---- the pointer: turn, mark, box -------------------------------------------------------------------------

const canvas = app.view.canvas;
let down: { x: number; y: number; isBox: boolean; button: number } | null = null;
const box = byId("box");

canvas.addEventListener("pointerdown", (event) => {
  down = { x: event.clientX, y: event.clientY, isBox: event.shiftKey && event.button === 0, button: event.button };
  if (down.isBox) {
    app.view.controls.enabled = false;
    canvas.setPointerCapture(event.pointerId);
  }
}, { capture: true });

canvas.addEventListener("pointermove", (event) => {
  if (down?.isBox) {
    const rect = canvas.parentElement!.getBoundingClientRect();
    const [x0, x1] = [Math.min(down.x, event.clientX), Math.max(down.x, event.clientX)];
    const [y0, y1] = [Math.min(down.y, event.clientY), Math.max(down.y, event.clientY)];
    box.hidden = false;
    box.style.cssText = `left:${x0 - rect.left}px;top:${y0 - rect.top}px;width:${x1 - x0}px;height:${y1 - y0}px`;
  } else if (!down && app.model) hoverSoon(event.clientX, event.clientY);
});

const hoverAt = { x: 0, y: 0 };
let isHoverWaiting = false;
function hoverSoon(x: number, y: number) {
  Object.assign(hoverAt, { x, y });
  if (isHoverWaiting) return;
  isHoverWaiting = true;
  requestAnimationFrame(() => {
    isHoverWaiting = false;
    const id = app.view.pick(app.mode, hoverAt.x, hoverAt.y);
    app.setHover(id === null ? null : { kind: app.mode, id });
    canvas.style.cursor = id === null ? "default" : "pointer";
  });
}
canvas.addEventListener("pointerleave", () => app.setHover(null));

addEventListener("pointerup", (event) => {
  const began = down;
  down = null;
  if (!began) return;
  app.view.controls.enabled = true;
  box.hidden = true;
  const isClick = Math.hypot(event.clientX - began.x, event.clientY - began.y) < 4;
  if (began.isBox && !isClick) {
    const rect = {
      left: Math.min(began.x, event.clientX), right: Math.max(began.x, event.clientX),
      top: Math.min(began.y, event.clientY), bottom: Math.max(began.y, event.clientY),
    };
    const all = new Set([...app.marked, ...app.view.pickBox(app.mode, rect)]);
    app.setMarks(all, idsText(all));
  } else if (isClick && began.button === 0 && event.target === canvas) void click(event);
});

async function click(event: PointerEvent) {
  const id = app.view.pick(app.mode, event.clientX, event.clientY);
  if (id === null) return;
  if (event.altKey) return app.mark({ id, how: "symmetric" }, event.shiftKey);
  const next = new Set(app.marked);
  if (!next.delete(id)) next.add(id);
  app.setMarks(next, idsText(next));
}

canvas.addEventListener("dblclick", (event) => {
  const id = app.view.pick(app.mode, event.clientX, event.clientY);
  if (id !== null) void app.mark({ id, how: event.altKey ? "symmetric" : like.value }, event.shiftKey);
});

// ---- keys ---------------------------------------------------------------------------------------------------

addEventListener("keydown", (event) => {
  const target = event.target as HTMLElement;
  const isText = target.matches("input[type=text], input:not([type]), textarea");
  const isCommand = event.ctrlKey || event.metaKey;
  const key = event.key.toLowerCase();
  if (isCommand && key === "s") {
    event.preventDefault();
    void save();
    return;
  }
  if (byId<HTMLDialogElement>("dialog").open) return;
  if (isCommand && (key === "z" || key === "y") && !isText) {
    event.preventDefault();
    const isRedo = key === "y" || event.shiftKey;
    void app.change("POST", isRedo ? "/redo" : "/undo");
    return;
  }
  if (isText || isCommand || event.altKey || target.matches("select")) return;
  const mode = ({ v: "vertex", e: "edge", f: "face" } as Record<string, Element>)[key];
  if (mode) app.setMode(mode);
  else if (key === "g") {
    const scope = app.cutting[app.mode].find(([name]) => name === "scope")?.[1];
    const next = scope === "local" ? "global" : "local";
    app.say(`cuts are ${next}`);
    void app.setCutting("scope", next === "local" ? "local" : undefined);
  } else if (key === "x") xray.click();
  else if (key === "escape") app.setMarks([], "");
  else if (key === "home" && target === canvas) app.view.home();
  else if (key === "enter" && !target.matches("button, summary, a, input")) void app.performCut();
});

// ---- files ----------------------------------------------------------------------------------------------------

const dialog = byId<HTMLDialogElement>("dialog");
const attempt = async (task: () => Promise<void>) => {
  try {
    await task();
  } catch (error) {
    app.refuse(error);
    const fault = dialog.querySelector<HTMLElement>(".fault");
    if (fault && error instanceof Refusal) fault.textContent = `${error.message} (${error.code})`;
  }
};

async function openFile(file: string) {
  app.at = null;
  if (await app.change("PUT", "/recipe", { file })) {
    app.setMarks([], "");
    app.view.home();
  }
}

byId("open").addEventListener("click", () => attempt(async () => {
  const { files, folder } = await api.getJson<{ files: string[]; folder: string }>("/api/files");
  const shown = files.filter((name) => /\.(toml|obj|ply|stl|off)$/i.test(name));
  const upload = h("input", { type: "file", accept: ".toml,.obj,.ply,.stl,.off,.glb,.3mf", "aria-label": "A file from elsewhere" });
  upload.addEventListener("change", () => {
    if (upload.files?.length) void take(upload.files[0]);
    dialog.close();
  });
  dialog.replaceChildren(
    h("h2", {}, `Open from ${folder}`),
    shown.length
      ? h("ul", { class: "files" }, ...shown.map((name) => h("li", {}, h("button", {
        onclick: () => {
          dialog.close();
          void openFile(name);
        },
      }, name))))
      : h("p", {}, "There are no recipes and no meshes in this folder."),
    h("p", {}, "From elsewhere: ", upload),
    h("div", { class: "buttons" }, h("button", { onclick: () => dialog.close() }, "Close")),
  );
  dialog.showModal();
}));

/** A file that was dropped or chosen: it is put into the folder and opened. */
function take(file: File) {
  return attempt(async () => {
    if (/\.toml$/i.test(file.name)) {
      app.at = null;
      await app.change("PUT", "/recipe", { text: await file.text() });
      return;
    }
    await api.post(`/api/files/${encodeURIComponent(file.name)}`, file, "PUT");
    await openFile(file.name);
  });
}

/** Puts files of outlines into the folder and joins them: one with itself, or two. */
async function joinOutlines(files: File[]) {
  for (const file of files) await api.post(`/api/files/${encodeURIComponent(file.name)}`, file, "PUT");
  app.at = null;
  if (await app.change("PUT", "/recipe", { text: outlineRecipe(files.map((file) => file.name)) })) {
    app.setMarks([], "");
    app.view.home();
  }
}

const drawOne = () => drawOutline(dialog, (points) => attempt(async () => {
  const { files } = await api.getJson<{ files: string[] }>("/api/files");
  let number = 1;
  while (files.includes(`outline-${number}.csv`)) number += 1;
  await joinOutlines([new File([outlineText(points)], `outline-${number}.csv`)]);
  dialog.close();
}));

addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
  event.preventDefault();
  const files = [...(event.dataTransfer?.files ?? [])];
  const outlines = files.filter((file) => isOutline(file.name)).sort((a, b) => (a.name < b.name ? -1 : 1));
  if (outlines.length > 2) app.say("a D-form is joined of one outline or of two; drop no more at once", true);
  else if (outlines.length) void attempt(() => joinOutlines(outlines));
  else if (files[0]) void take(files[0]);
});

const proposed = () =>
  app.recipe.file ?? `${(app.recipe.name ?? "recipe").toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "recipe"}.toml`;

async function save() {
  if (app.recipe.file) {
    await attempt(async () => {
      app.take(await api.post(app.path("/save"), {}));
      app.say(`saved ${app.recipe.file}`);
    });
    return;
  }
  const file = h("input", { type: "text", id: "save-file", value: proposed(), "aria-label": "File name" });
  const go = () => attempt(async () => {
    app.take(await api.post(app.path("/save"), { file: file.value }));
    app.say(`saved ${app.recipe.file}`);
    dialog.close();
  });
  ask("Save the recipe", [h("label", {}, "file ", file)], "Save", go);
}

function ask(title: string, fields: HTMLElement[], word: string, go: () => Promise<void>, others: HTMLElement[] = []) {
  const box = h("form", { method: "dialog" },
    h("h2", {}, title), ...fields, h("p", { class: "fault", role: "alert" }),
    h("div", { class: "buttons" }, h("button", { type: "button", onclick: () => dialog.close() }, "Cancel"), ...others, h("button", { class: "main", type: "submit" }, word)));
  box.addEventListener("submit", (event) => {
    event.preventDefault();
    void go();
  });
  dialog.replaceChildren(box);
  dialog.showModal();
}

byId("save").addEventListener("click", () => void save());

byId("export").addEventListener("click", () => {
  const file = h("input", { type: "text", id: "export-file", value: proposed() });
  const folder = h("input", { type: "text", id: "export-folder", value: "out" });
  const replace = h("input", { type: "checkbox", id: "export-replace" });
  const go = () => attempt(async () => {
    const body = { file: file.value, folder: folder.value, replace: replace.checked };
    app.say("writing…");
    const told = await api.post<{ written: string[]; command: string }>(app.path("/export"), body);
    app.take(await api.getJson(app.path("")));
    app.say(`wrote ${told.written.length} files into ${folder.value}; the same in a terminal: ${told.command}`);
    dialog.close();
  });
  const archive = h("button", { type: "button", onclick: () => {
    const named = `file=${encodeURIComponent(file.value)}&folder=${encodeURIComponent(folder.value)}`;
    download(api.withToken(app.path(`/export.zip?${named}`)), "kerfold.zip");
    dialog.close();
  } }, "As zip");
  ask("Export all files", [
    h("label", { for: "export-file" }, "recipe"), file,
    h("label", { for: "export-folder" }, "folder"), folder,
    h("label", { class: "check" }, replace, " replace another recipe of this name"),
  ], "Write", go, [archive]);
});

byId("undo").addEventListener("click", () => void app.change("POST", "/undo"));
byId("redo").addEventListener("click", () => void app.change("POST", "/redo"));
const name = byId<HTMLInputElement>("name");
name.addEventListener("change", () => void app.change("PUT", "/name", { name: name.value || null }));
app.on("recipe", () => {
  if (document.activeElement !== name) name.value = app.recipe.name ?? "";
  byId("file").textContent = app.recipe.file ?? "not saved";
  byId<HTMLButtonElement>("undo").disabled = !app.recipe.undo;
  byId<HTMLButtonElement>("redo").disabled = !app.recipe.redo;
  for (const id of ["save", "export"]) byId<HTMLButtonElement>(id).disabled = !app.recipe.steps.length;
});

// ---- begin -----------------------------------------------------------------------------------------------------

/** For scripts that drive the page: where elements are drawn, and how long frames took. */
declare global {
  interface Window {
    studio: unknown;
  }
}
window.studio = {
  app,
  /** Where an element is on the page, and whether it can be seen there. */
  where(kind: Element, id: number) {
    const middle = app.model?.middle(kind, id);
    return middle ? { ...app.view.toPage(middle), seen: app.view.isSeen(middle) } : null;
  },
};

app.start().then(
  () => {
    left(app);
    right(app);
    byId("draw-outline").addEventListener("click", drawOne);
    for (const topic of ["recipe", "model", "marks", "result"] as const) app.tell(topic);
    document.body.dataset.ready = "true";
  },
  (error) => {
    app.refuse(error);
    byId("welcome").replaceChildren(h("h2", {}, "The studio cannot be reached"), h("p", {}, error instanceof Error ? error.message : String(error)));
    byId("welcome").hidden = false;
  },
);
