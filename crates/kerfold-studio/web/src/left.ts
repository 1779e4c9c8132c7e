// The steps and the cutting.

import type { App } from "./app";
import type { Step, Value } from "./api";
import { byId, h } from "./dom";
import { form, markLimit, showFault, shown } from "./forms";
import { type Kind, labelOf, valueOf } from "./schema";

const GROUPS: [string, string][] = [
  ["begin", "Begin"], ["shape", "Change the model"], ["look", "Judge and show"], ["make", "Pieces and sheets"],
];
const SOLIDS = ["tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron", "truncated-octahedron", "soccer-ball", "prism-6"];

export function left(app: App) {
  const pane = byId("left");
  const list = h("ol", { class: "steps", id: "steps" });
  const add = h("select", { id: "add", "aria-label": "A step to add" });
  const addNow = h("button", { id: "add-step", disabled: true }, "Add");
  const adding = h("div", { class: "adding" }, add, addNow);
  const cutting = h("section", { class: "cutting", "aria-label": "Cutting" });
  pane.append(h("h2", {}, "Steps"), list, adding, cutting);
  let open: number | null = null;

  add.append(h("option", { value: "" }, "Add a step…"));
  for (const [group, title] of GROUPS) {
    const kinds = app.kinds.filter((kind) => kind.group === group);
    add.append(h("optgroup", { label: title }, ...kinds.map((kind) => h("option", { value: kind.title }, kind.title))));
  }
  add.addEventListener("change", () => (addNow.disabled = !add.value));
  addNow.addEventListener("click", () => {
    const kind = app.kinds.find((kind) => kind.title === add.value);
    add.value = "";
    addNow.disabled = true;
    if (kind) draft(kind);
  });

  /** A new step: at once where nothing is required, else after its required keys are filled in. */
  function draft(kind: Kind) {
    let step: Step = [[kind.verb, kind.value ?? firstValue(kind)]];
    const isDone = () => kind.keys.every((key) => !key.isRequired || (valueOf(step, key.name) ?? "") !== "");
    const apply = async () => {
      if (await app.apply(step)) {
        open = app.steps - 1;
        drawSteps();
      }
    };
    if (isDone()) return void apply();
    const dialog = byId<HTMLDialogElement>("dialog");
    const button = h("button", { class: "main", disabled: true }, "Add the step");
    const box = form(kind, step, {
      change: (key, value) => {
        const rest = step.filter(([name]) => name !== key);
        const isVerb = key === kind.verb;
        step = value === undefined ? rest : isVerb ? [[key, value], ...rest] : [...rest, [key, value]];
        button.disabled = !isDone();
      },
    });
    button.addEventListener("click", () => {
      dialog.close();
      void apply();
    });
    dialog.replaceChildren(
      h("h2", {}, kind.title), box,
      h("div", { class: "buttons" }, h("button", { onclick: () => dialog.close() }, "Cancel"), button),
    );
    dialog.showModal();
  }

  function firstValue(kind: Kind): Value {
    const key = kind.keys.find((key) => key.name === kind.verb)!;
    return key.default ?? key.choices[0]?.word ?? "";
  }

  function summary(step: Step) {
    return step.slice(1).map(([key, value]) => `${labelOf(key)} ${shown(value)}`).join(", ");
  }

  function drawSteps() {
    const { steps } = app.recipe;
    const focus = document.activeElement?.closest<HTMLElement>("[data-key]")?.dataset.key;
    const isRange = (document.activeElement as HTMLInputElement)?.type === "range";
    list.replaceChildren(
      ...steps.map((step, i) => {
        const kind = app.kind(step);
        const title = kind?.value ? kind.title : `${step[0][0]} ${shown(step[0][1])}`;
        const isShown = app.steps === i + 1;
        const head = h("button", {
          class: "head", "aria-expanded": String(open === i), "aria-current": isShown ? "step" : undefined,
          onclick: () => {
            open = open === i ? null : i;
            drawSteps();
          },
        }, h("b", {}, `${i + 1} ${title}`), h("small", {}, summary(step)));
        const eye = h("button", {
          class: "eye", title: "Show the model after this step", "aria-label": `Show the model after step ${i + 1}`,
          "aria-pressed": String(isShown),
          onclick: () => {
            app.at = i + 1 === steps.length ? null : i + 1;
            drawSteps();
            void app.refresh();
          },
        }, isShown ? "◉" : "○");
        const gone = h("button", {
          class: "gone", title: "Take this step away", "aria-label": `Take step ${i + 1} away`,
          onclick: () => {
            if (app.at !== null && app.at > i) app.at = null;
            open = null;
            void app.change("DELETE", `/steps/${i + 1}`);
          },
        }, "×");
        const row = h("li", { class: isShown ? "shown" : "" }, h("div", { class: "row" }, eye, head, gone));
        if (open === i && kind) {
          row.append(form(kind, step, { change: (key, value, gesture) => void app.set(i + 1, key, value, gesture) }));
        }
        return row;
      }),
    );
    if (focus) {
      const again = list.querySelector<HTMLElement>(`[data-key="${focus}"] input${isRange ? "[type=range]" : ":not([type=range])"}, [data-key="${focus}"] select`);
      again?.focus();
    }
    if (app.fault?.key) showFault(pane, app.fault.key, `${app.fault.message} (${app.fault.code})`);
  }

  let isDragging = false;
  list.addEventListener("pointerdown", (event) => (isDragging = (event.target as HTMLInputElement).type === "range"));
  addEventListener("pointerup", () => {
    if (isDragging) setTimeout(drawSteps, 0);
    isDragging = false;
  });
  // The form under the pointer must not be made anew while it is dragged.
  app.on("recipe", () => {
    if (!isDragging) drawSteps();
  });

  // ---- cutting -----------------------------------------------------------------------------------

  const select = h("input", { id: "selection", type: "text", spellcheck: "false", autocomplete: "off", placeholder: "nothing marked", "aria-describedby": "selection-help" });
  select.addEventListener("change", () => {
    const text = select.value.trim();
    if (text) void app.mark({ selection: text });
    else app.setMarks([], "");
  });
  const perform = h("button", { id: "perform", class: "main", title: "Enter", onclick: () => void app.performCut() }, "Perform cutting");
  const about = h("p", { class: "about", id: "selection-help" });
  const forms = h("div", {});
  const modes = h("div", { class: "modes", role: "radiogroup", "aria-label": "What is marked and cut" });
  for (const mode of ["vertex", "edge", "face"] as const) {
    const radio = h("input", { type: "radio", name: "mode", id: `mode-${mode}`, value: mode, checked: mode === app.mode });
    radio.addEventListener("change", () => app.setMode(mode));
    modes.append(radio, h("label", { for: `mode-${mode}`, title: `${mode[0].toUpperCase()}` }, mode));
  }
  cutting.append(
    h("h2", {}, "Cutting"), modes,
    h("div", { class: "field" }, h("label", { for: "selection" }, "marked"), select), about, forms, perform,
  );

  function drawForms() {
    const kind = app.kinds.find((kind) => kind.verb === "cut" && kind.value === app.mode);
    if (!kind) return;
    const box = form(kind, app.cutting[app.mode], {
      hide: ["select"],
      change: (key, value) => {
        void app.setCutting(key, value);
        const isSlider = (document.activeElement as HTMLInputElement)?.type === "range";
        if (!isSlider) drawForms();
      },
    });
    forms.replaceChildren(box);
    markLimit(forms, app.limit);
  }

  function drawMarks() {
    if (document.activeElement !== select || app.selection) select.value = app.selection;
    const count = app.marked.size;
    about.textContent = count
      ? `${count} of ${app.model?.ids(app.mode).length ?? 0} marked`
      : "Click the model, double-click for all in the same direction, shift-drag a box, or type: all, fold>30deg, along=z";
    perform.disabled = !count;
  }

  let mode = app.mode;
  app.on("cutting", () => {
    if (mode !== app.mode) drawForms();
    mode = app.mode;
    modes.querySelector<HTMLInputElement>(`#mode-${mode}`)!.checked = true;
    markLimit(forms, app.limit);
    const overcut = app.preview?.told.cut?.overcut?.length ?? 0;
    cutting.classList.toggle("overcut", overcut > 0);
  });
  app.on("marks", drawMarks);
  app.on("model", () => {
    cutting.hidden = !app.model;
    adding.hidden = !app.recipe.steps.length;
    drawMarks();
  });
  drawForms();
  drawMarks();

  // ---- the first step ------------------------------------------------------------------------------

  const welcome = byId("welcome");
  const size = h("input", { id: "first-size", type: "text", value: "180mm", "aria-label": "Size of the solid" });
  welcome.append(
    h("h2", {}, "Begin with a solid"),
    h("div", { class: "solids" }, ...SOLIDS.map((name) => h("button", {
      "data-solid": name,
      onclick: () => void app.apply([["solid", name], ["size", size.value || "180mm"]]),
    }, name.replaceAll("-", " ")))),
    h("p", {}, "largest extent ", size),
    h("p", {}, "or ", h("button", { id: "draw-outline" }, "draw an outline…"), " of a D-form, or drop one or two drawings of it (SVG, DXF, CSV)"),
    h("p", {}, "or drop a mesh (OBJ, PLY, STL, OFF, GLB, 3MF) or a recipe here, or ", h("button", { onclick: () => byId("open").click() }, "open one…")),
  );
  app.on("recipe", () => (welcome.hidden = app.recipe.steps.length > 0));
}
