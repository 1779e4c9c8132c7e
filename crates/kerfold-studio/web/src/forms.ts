// Forms from the schema: sliders with typed numbers where a key has a range, fields where not.

import type { Step, Value } from "./api";
import { h } from "./dom";
import { type Key, type Kind, labelOf, valueOf } from "./schema";

export interface FormHooks {
  /** A value was changed; undefined takes the key away. `gesture` is the same during a drag. */
  change(key: string, value: Value | undefined, gesture: number | null): void;
  /** Keys that have a place of their own elsewhere. */
  hide?: string[];
}

/** Keys that are seen at once; the others are behind a word. */
const FIRST: Record<string, string[]> = {
  cut: ["select", "offset", "bend", "roll", "strips", "strip", "scope", "repeat", "normal", "point", "keep"],
  unfold: ["unfold", "sheet", "kerf", "joint", "material", "gap"],
  dform: ["dform", "rounds", "offset", "roll", "strips", "outlines", "start", "sheet", "kerf"],
  panels: ["panels", "thickness", "gap", "sheet", "material"],
};
const MOST_AT_ONCE = 7;

let gestures = Date.now() % 1_000_000_000;
export const nextGesture = () => ++gestures;

let names = 0;

/** The form of a step. Keys without a value show their default. */
export function form(kind: Kind, step: Step, hooks: FormHooks): HTMLElement {
  const keys = kind.keys.filter((key) => !hooks.hide?.includes(key.name));
  const shown = keys.filter((key) => !(key.name === kind.verb && kind.value !== null));
  const wanted = FIRST[kind.verb];
  const isFirst = (key: Key, i: number) =>
    key.isRequired || valueOf(step, key.name) !== undefined || (wanted ? wanted.includes(key.name) : i < MOST_AT_ONCE);
  const first = shown.filter(isFirst);
  if (wanted) first.sort((a, b) => rank(wanted, a.name) - rank(wanted, b.name));
  const others = shown.filter((key) => !first.includes(key));
  const box = h("div", { class: "form" }, ...first.map((key) => field(key, step, hooks)));
  if (others.length) {
    const more = h("details", {}, h("summary", {}, `More (${others.length})`));
    // A step with sheets has fifty keys; most are never looked at.
    more.addEventListener("toggle", () => more.append(...others.map((key) => field(key, step, hooks))), { once: true });
    box.append(more);
  }
  return box;
}

const rank = (order: string[], name: string) => (order.includes(name) ? order.indexOf(name) : -1);

function field(key: Key, step: Step, hooks: FormHooks): HTMLElement {
  const id = `f${++names}`;
  const value = valueOf(step, key.name);
  const label = h("label", { for: id, title: key.help }, labelOf(key.name), key.unit && h("small", {}, ` ${key.unit}`));
  const row = h("div", { class: "field", "data-key": key.name }, label);
  if (value !== undefined && !key.isRequired) {
    row.append(
      h("button", {
        class: "reset",
        title: "Back to the default",
        "aria-label": `${labelOf(key.name)}: back to the default`,
        onclick: () => hooks.change(key.name, undefined, null),
      }, "×"),
    );
  }
  row.append(...control(key, id, value, hooks), h("p", { class: "fault", hidden: true, role: "alert" }));
  return row;
}

function control(key: Key, id: string, value: Value | undefined, hooks: FormHooks): HTMLElement[] {
  const set = (value: Value | undefined, gesture: number | null = null) => hooks.change(key.name, value, gesture);
  if (key.kind === "switch") {
    const box = h("input", { id, type: "checkbox", checked: value === true, title: key.help });
    box.addEventListener("change", () => set(box.checked ? true : undefined));
    return [box];
  }
  if (key.kind === "choice" && !key.isList) {
    const now = String(value ?? key.default ?? "");
    const list = h("select", { id, title: key.help });
    if (!key.choices.some((choice) => choice.word === now)) list.append(h("option", { value: "" }, "–"));
    for (const { word, help } of key.choices) list.append(h("option", { value: word, title: help }, word));
    list.value = now;
    list.addEventListener("change", () => set(list.value || undefined));
    return [list];
  }
  const slider = sliderRange(key, value);
  const examples = [...key.examples, ...key.choices.map((choice) => choice.word)];
  const text = h("input", {
    id,
    type: "text",
    inputmode: slider ? "decimal" : undefined,
    autocomplete: "off",
    spellcheck: "false",
    value: value === undefined ? "" : shown(value),
    placeholder: key.default === undefined ? (key.isRequired ? "required" : "none") : String(key.default),
    title: key.help,
    list: examples.length ? `${id}-list` : undefined,
  });
  text.addEventListener("change", () => set(typed(key, text.value)));
  const parts: HTMLElement[] = [text];
  if (examples.length) {
    parts.push(h("datalist", { id: `${id}-list` }, ...examples.map((word) => h("option", { value: word }))));
  }
  if (slider) {
    const range = h("input", {
      type: "range",
      min: slider.low,
      max: slider.high,
      step: slider.step,
      value: String(slider.at),
      "aria-label": `${labelOf(key.name)}, slider`,
      title: key.help,
    });
    let gesture = 0;
    const begin = () => (gesture = nextGesture());
    range.addEventListener("pointerdown", begin);
    range.addEventListener("keydown", begin);
    range.addEventListener("input", () => {
      const unit = typeof value === "string" ? unitOf(value) : "";
      const number = +range.value;
      text.value = unit ? `${number}${unit}` : String(number);
      set(unit ? text.value : number, gesture);
    });
    parts.unshift(range);
  }
  return parts;
}

export const shown = (value: Value): string => (Array.isArray(value) ? value.map(shown).join(", ") : String(value));

/** The unit of a quantity as it is typed; nothing for what is none. */
export const unitOf = (text: string) => /^-?[\d.]+\s*([a-zµ"']+)$/i.exec(text)?.[1] ?? "";

/** What was typed, as the value that the recipe gets: numbers without quotes. */
function typed(key: Key, text: string): Value | undefined {
  const trimmed = text.trim();
  if (!trimmed) return undefined;
  const number = /^-?(\d+\.?\d*|\.\d+)(e-?\d+)?$/i.test(trimmed);
  if (number && ["number", "integer", "length", "angle"].includes(key.kind) && !key.isList) return +trimmed;
  if (key.isList) {
    const parts = trimmed.split(/\s*,\s*/);
    return parts.every((part) => /^-?\d+$/.test(part)) ? parts.map(Number) : parts;
  }
  if (number && key.kind === "text" && /^\d+$/.test(trimmed)) return +trimmed;
  return trimmed;
}

function sliderRange(key: Key, value: Value | undefined) {
  if (key.isList) return null;
  const now = parseFloat(String(value ?? key.default ?? ""));
  if (key.range) {
    const [low, high] = key.range;
    const step = key.kind === "integer" ? 1 : (high - low) / 400;
    const isOpen = low === 0 && key.kind === "number";
    const most = key.kind === "integer" ? Math.min(high, Math.max(12, now || 0)) : high;
    return { low: isOpen ? step : low, high: most, step, at: Number.isFinite(now) ? now : low };
  }
  if (key.kind === "integer") return { low: 0, high: Math.max(10, 2 * (now || 0)), step: 1, at: now || 0 };
  // A text that is a quantity by now, such as a radius that may be `max` as well.
  const isQuantity = key.kind === "text" && typeof value === "string" && unitOf(value) !== "";
  if ((!isQuantity && !["number", "length", "angle"].includes(key.kind)) || !Number.isFinite(now) || now === 0) return null;
  const high = 2 * Math.abs(now);
  return { low: now < 0 ? -high : 0, high, step: high / 200, at: now };
}

/** Marks on a slider the largest value at which no cuts meet. */
export function markLimit(box: HTMLElement, limit: { key: string; value: number } | null) {
  box.querySelector(".limit")?.remove();
  if (!limit) return;
  const { key, value } = limit;
  const row = box.querySelector<HTMLElement>(`.field[data-key="${key}"]`);
  const range = row?.querySelector<HTMLInputElement>("input[type=range]");
  if (!row || !range || value >= +range.max) return;
  const share = (value - +range.min) / (+range.max - +range.min);
  const text = `cuts meet above ${value.toFixed(3)}`;
  row.append(h("span", { class: "limit", style: `--at:${share}`, title: text, role: "note" }, text));
}

export function showFault(box: HTMLElement, key: string | null, message: string) {
  const fault = key && box.querySelector<HTMLElement>(`.field[data-key="${CSS.escape(key)}"] .fault`);
  if (fault) {
    fault.textContent = message;
    fault.hidden = false;
  }
  return Boolean(fault);
}
