// What all panes share: the recipe, the model, what is marked, and how they follow one another.

import * as api from "./api";
import { type Arrays, Refusal, type Recipe, type Step, type Value } from "./api";
import { byId } from "./dom";
import { unitOf } from "./forms";
import { type Element, Model } from "./model";
import { type Kind, kindOf, kindsOf, withKey } from "./schema";
import { View } from "./view";

export interface FlatFace { face: number; vertices: number[]; polygon: [number, number][] }
export interface Piece { id: string; outline: [number, number][]; holes: [number, number][][]; faces: FlatFace[] }
type Segment = [[number, number], [number, number]];
export interface Pieces {
  pieces: Piece[];
  folds: { id: string; piece: string; segment: Segment; fold_angle: number; kind: string }[];
  seams: { id: string; length: number; sides: { piece: string; face: number; segment: Segment }[] }[];
  proof: { congruence_mm: number; refold_mm: number; overlaps: number };
}
export interface Layout {
  sheets: { id: string; width: number; height: number; placed: { piece: string; x: number; y: number; rotation: number }[] }[];
  density: number;
  cut_length: number;
  score_length: number;
}
export interface Result {
  revision: number;
  command: string;
  notes: string[];
  unclean: string[];
  report: any | null;
  pieces: Pieces | null;
  layout: Layout | null;
  seconds: number | null;
  panels: any | null;
  failure: { code: string; message: string } | null;
  closing_seconds: number;
}
export interface SeamRow {
  matching: number | string;
  selection: string;
  folds: number[];
  orbit: number | null;
  pieces: number;
  fold_sum: number;
}
export type Hover = { kind: Element; id: number } | null;

type Topic = "recipe" | "model" | "marks" | "result" | "hover" | "cutting" | "work";

export class App {
  tab = "";
  recipe!: Recipe;
  kinds: Kind[] = [];
  /** After how many steps the model is shown; null follows the end. */
  at: number | null = null;
  model: Model | null = null;
  preview: Model | null = null;
  result: Result | null = null;
  svgs: string[] = [];
  mode: Element = "edge";
  marked = new Set<number>();
  selection = "";
  /** What "perform cutting" would do: all keys but the selection. */
  cutting: Record<Element, Step> = {
    vertex: [["cut", "vertex"], ["offset", 0.25]],
    edge: [["cut", "edge"], ["offset", 0.25]],
    face: [["cut", "face"], ["offset", 0.25]],
  };
  hover: Hover = null;
  readonly view = new View(byId<HTMLCanvasElement>("canvas"));
  private readonly listeners = new Map<Topic, (() => void)[]>();
  private resultStop: AbortController | null = null;
  private resultTimer = 0;
  private limitTimer = 0;
  private limitStop: AbortController | null = null;
  /** The largest value of the key at which no cuts meet. */
  limit: { key: string; value: number } | null = null;
  /** How long the last frame of a slider took, in ms; for the bench. */
  frames: number[] = [];
  work = "";

  on(topic: Topic, listener: () => void) {
    this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  tell(topic: Topic) {
    for (const listener of this.listeners.get(topic) ?? []) listener();
  }

  say(text: string, isBad = false) {
    const status = byId("status");
    status.textContent = text;
    status.classList.toggle("bad", isBad);
  }

  /** Shows a refusal as the terminal would print it. */
  refuse(error: unknown) {
    if (error instanceof Refusal) {
      if (error.code !== "E907") this.say(error.code ? `${error.message} (${error.code})` : error.message, true);
    } else this.say(String(error), true);
  }

  path(rest: string) {
    return `/api/tabs/${this.tab}${rest}`;
  }

  async start() {
    this.kinds = kindsOf(await api.getJson("/api/schema"));
    const resume = sessionStorage.getItem("tab");
    this.take(await api.post<Recipe>("/api/tabs", { resume }));
    sessionStorage.setItem("tab", this.tab);
    const events = new EventSource(api.withToken(this.path("/events")));
    events.onmessage = (event) => {
      const told = JSON.parse(event.data);
      if (told.warning) this.say(told.warning, true);
      else if (this.working || this.pending) {
        this.work = told.total ? `${told.work} ${told.done}/${told.total}` : told.work;
        this.tell("work");
      }
    };
    await this.refresh();
  }

  take(recipe: Recipe) {
    this.recipe = recipe;
    this.tab = recipe.tab;
    this.tell("recipe");
  }

  get steps() {
    return this.at === null ? this.recipe.steps.length : Math.min(this.at, this.recipe.steps.length);
  }

  kind(step: Step) {
    return kindOf(this.kinds, step);
  }

  /** Changes the recipe and follows: the model at once, pieces and sheets when it rests. */
  async change(method: string, rest: string, body?: unknown): Promise<boolean> {
    this.pending++;
    try {
      return await this.changeNow(method, rest, body);
    } finally {
      this.pending--;
    }
  }

  /** Changes that are on their way. */
  pending = 0;

  private async changeNow(method: string, rest: string, body?: unknown): Promise<boolean> {
    try {
      this.take(await api.post<Recipe>(this.path(rest), body, method));
    } catch (error) {
      this.refuse(error);
      this.fault = error instanceof Refusal ? error : null;
      this.tell("recipe");
      return false;
    }
    this.fault = null;
    await this.refresh();
    return true;
  }

  fault: Refusal | null = null;

  apply(step: Step) {
    const at = this.at === null ? undefined : this.at + 1;
    if (this.at !== null) this.at = this.at + 1;
    return this.change("POST", "/steps", { step, at });
  }

  private waiting: { step: number; key: string; value: Value | undefined; gesture: number | null } | null = null;
  private readonly send = api.newest(async () => {
    const one = this.waiting;
    if (!one) return;
    this.waiting = null;
    const begin = performance.now();
    const { step, key, value, gesture } = one;
    await this.change("PATCH", `/steps/${step}`, { key, value: value ?? null, gesture });
    this.view.renderNow();
    this.frames.push(performance.now() - begin);
  });

  /** Sets a value; of those that come while one is on its way only the newest counts. */
  set(step: number, key: string, value: Value | undefined, gesture: number | null) {
    this.waiting = { step, key, value, gesture };
    this.pending++;
    return this.send().finally(() => this.pending--);
  }

  /** The model anew, and then what follows from it. */
  async refresh() {
    this.scheduleResult();
    try {
      const steps = this.steps;
      if (steps === 0) this.setModel(null);
      else this.setModel(new Model(await api.getArrays(this.path(`/model?steps=${steps}`))));
      this.clearFault();
    } catch (error) {
      this.refuse(error);
    }
  }

  private clearFault() {
    const notes = (this.model?.told.notes ?? []) as string[];
    this.say(notes.length ? notes[notes.length - 1] : "");
  }

  private setModel(model: Model | null) {
    this.model = model;
    this.preview = null;
    const ids = model ? new Set(model.ids(this.mode)) : new Set<number>();
    const kept = [...this.marked].filter((id) => ids.has(id));
    this.marked = new Set(kept);
    this.view.show(model);
    this.view.mark({ kind: this.mode, ids: this.marked });
    this.tell("model");
  }

  // ---- marking and cutting ----------------------------------------------------------------------

  setMode(mode: Element) {
    this.mode = mode;
    this.setMarks([], "");
    this.tell("cutting");
  }

  setMarks(ids: Iterable<number>, selection: string) {
    this.marked = new Set(ids);
    this.selection = selection;
    this.view.mark({ kind: this.mode, ids: this.marked });
    this.tell("marks");
    void this.look();
  }

  /** Marks what a text says, or what is like an element. */
  async mark(asked: { selection?: string; id?: number; how?: string }, isMore = false) {
    try {
      const told = await api.post<{ selection: string; ids: number[] }>(this.path("/mark"), {
        steps: this.steps, kind: this.mode, ...asked,
      });
      const isJoined = isMore && this.selection !== "";
      const text = isJoined ? `${this.selection} | ${told.selection}` : told.selection;
      this.setMarks(isJoined ? [...this.marked, ...told.ids] : told.ids, text);
      this.say(`${told.ids.length} marked`);
    } catch (error) {
      this.refuse(error);
      this.tell("marks");
    }
  }

  get cut(): Step {
    return withKey(this.cutting[this.mode], "select", this.selection);
  }

  setCutting(key: string, value: Value | undefined) {
    let step = withKey(this.cutting[this.mode], key, value);
    // An edge is cut by offset or rolled; the one takes the place of the other.
    if (value !== undefined && key === "roll") for (const other of ["offset", "bend", "disjoint"]) step = withKey(step, other, undefined);
    if (value !== undefined && key === "offset") for (const other of ["roll", "strips", "strip"]) step = withKey(step, other, undefined);
    this.cutting[this.mode] = step;
    return this.look();
  }

  private readonly lookNow = api.newest(async () => {
    if (!this.model) return;
    const begin = performance.now();
    if (!this.marked.size) {
      if (this.preview) this.clearFault();
      this.preview = null;
      this.view.show(this.model);
      this.tell("cutting");
      return;
    }
    try {
      const body = { steps: this.steps, step: this.cut };
      this.preview = new Model(await api.postArrays(this.path("/preview"), body));
      const overcut = (this.preview.told.cut?.overcut ?? []) as number[];
      this.view.show(this.model, this.preview, overcut);
      this.view.mark({ kind: this.mode, ids: this.marked });
      const notes = this.preview.told.notes as string[];
      if (overcut.length) this.say(notes[0] ?? "cuts meet", true);
      else this.say(notes[0] ?? "");
    } catch (error) {
      this.preview = null;
      this.view.show(this.model);
      this.refuse(error);
    }
    this.view.renderNow();
    this.frames.push(performance.now() - begin);
    this.tell("cutting");
  });

  /** Shows what the cut would do, before it is made. */
  look() {
    clearTimeout(this.limitTimer);
    // The picture comes first; the limit is looked for when the slider rests.
    this.limitStop?.abort();
    this.limitTimer = window.setTimeout(() => void this.findLimit(), 350);
    return this.lookNow();
  }

  /** How far the offset may go before cuts meet; of edges that are rolled, the radius. */
  private async findLimit() {
    if (!this.marked.size) {
      this.limit = null;
      this.tell("cutting");
      return;
    }
    try {
      const roll = this.cut.find(([key]) => key === "roll")?.[1];
      const unit = typeof roll === "string" ? unitOf(roll) : "";
      if (roll !== undefined && !unit) {
        // The largest radius of all is no slider.
        this.limit = null;
        this.tell("cutting");
        return;
      }
      const asked = unit ? { key: "roll", unit, from: 0, to: 4 * parseFloat(String(roll)) } : { key: "offset", from: 0, to: 2 };
      const body = { steps: this.steps, step: this.cut, ...asked };
      this.limitStop = new AbortController();
      const told = await api.post<{ value: number | null }>(this.path("/limit"), body, "POST", this.limitStop.signal);
      this.limit = told.value === null ? null : { key: asked.key, value: told.value };
      this.tell("cutting");
    } catch {
      // A newer value asks again.
    }
  }

  async performCut() {
    if (!this.marked.size) return this.say("mark something first", true);
    const isDone = await this.apply(this.cut);
    if (!isDone || !this.model) return;
    // The strips just made stay marked for the next round; of other cuts what they made.
    const strip = this.mode === "edge" ? this.model.made("strip") : this.model.made(this.mode);
    this.setMarks([], "");
    if (strip.length) {
      this.marked = new Set(strip);
      this.selection = this.mode === "edge" ? "strip" : "made";
      this.view.mark({ kind: this.mode, ids: this.marked });
      this.tell("marks");
    }
  }

  // ---- pieces and sheets ------------------------------------------------------------------------

  private scheduleResult() {
    this.resultStop?.abort();
    clearTimeout(this.resultTimer);
    this.resultTimer = window.setTimeout(() => void this.loadResult(), 120);
  }

  named() {
    return `file=${encodeURIComponent(this.recipe.file ?? "recipe.toml")}&folder=out`;
  }

  private working = 0;

  private async loadResult() {
    this.working++;
    await this.loadResultNow();
    this.working--;
    this.work = "";
    this.tell("work");
  }

  private async loadResultNow() {
    const stop = new AbortController();
    this.resultStop = stop;
    if (!this.recipe.steps.length) {
      this.result = null;
      this.svgs = [];
      this.tell("result");
      return;
    }
    try {
      const result = await api.getJson<Result>(this.path(`/result?${this.named()}`), stop.signal);
      const svgs: string[] = [];
      const count = result.failure ? 0 : (result.layout?.sheets.length ?? 0);
      for (let i = 1; i <= Math.min(count, 12); i++) {
        svgs.push(await api.getText(this.path(`/sheets/${i}?${this.named()}`), stop.signal));
      }
      if (stop.signal.aborted) return;
      this.result = result;
      this.svgs = svgs;
      const piece = new Map<number, string>();
      result.pieces?.pieces.forEach((p) => p.faces.forEach((f) => piece.set(f.face, p.id)));
      this.view.piece = piece;
      if (this.view.colourBy === "piece") this.view.rebuild();
      this.tell("result");
    } catch (error) {
      if (error instanceof Refusal && error.code === "E907") return;
      this.refuse(error);
    }
  }

  setHover(hover: Hover) {
    if (hover?.kind === this.hover?.kind && hover?.id === this.hover?.id) return;
    this.hover = hover;
    this.view.hover(hover ? [hover] : []);
    this.tell("hover");
  }

  async seams(): Promise<{ rows: SeamRow[]; note: string | null; steps: number; model: Model } | null> {
    // The seams are those of the solid before it is cut.
    const first = this.recipe.steps.findIndex(([[verb]]) => verb === "cut" || verb === "dform" || verb === "unfold");
    const steps = first < 0 ? this.recipe.steps.length : first;
    if (!steps) return null;
    const model = new Model(await api.getArrays(this.path(`/model?steps=${steps}`)));
    const told = await api.getJson<{ rows: SeamRow[]; note: string | null }>(this.path(`/seams?steps=${steps}`));
    return { ...told, steps, model };
  }

  film(seconds: number): Promise<Arrays> {
    return api.getArrays(this.path(`/bloom?seconds=${seconds}`));
  }
}
