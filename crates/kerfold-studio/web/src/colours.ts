// Colours of the model, and what they mean.

import { Color } from "three";
import { short } from "./dom";
import type { Model } from "./model";

export type ColourBy = "plain" | "piece" | "planarity" | "valence" | "fold" | "group";

/** Calm, told apart by those who see no red or green, too (after Okabe and Ito, 2008). */
const PALETTE = ["#7fb2d9", "#e6b566", "#78c2a4", "#d48ab0", "#f0e08a", "#5f86b5", "#d9825b", "#a9a4d6", "#9cc56b", "#c9b79c"];

export interface Painted {
  /** A colour for each face, by its place. */
  faces: Color[];
  /** A colour for each edge, by its place, where edges are coloured. */
  edges: Color[] | null;
  legend: { colour: string; text: string }[];
}

const ramp = (share: number) => new Color().setHSL(0.58 - 0.55 * Math.min(1, Math.max(0, share)), 0.55, 0.6);

export function paint(model: Model, by: ColourBy, isDark: boolean, piece: Map<number, string> | null): Painted {
  const plain = new Color(isDark ? "#8b97a5" : "#dfe4ea");
  const faces = Array.from(model.faces, () => plain);
  const swatch = (colour: Color) => `#${colour.getHexString()}`;
  const named = (names: string[], of: (place: number) => number) => {
    const colours = names.map((_, i) => new Color(PALETTE[i % PALETTE.length]));
    faces.forEach((_, i) => (faces[i] = colours[of(i)] ?? plain));
    const shown = names.slice(0, 12).map((text, i) => ({ colour: swatch(colours[i]), text }));
    if (names.length > 12) shown.push({ colour: "transparent", text: `and ${names.length - 12} more` });
    return { faces, edges: null, legend: shown };
  };
  const scale = (values: ArrayLike<number>, unit: string) => {
    let most = 0;
    for (let i = 0; i < values.length; i++) if (values[i] > most) most = values[i];
    return {
      of: (value: number) => ramp(most > 0 ? value / most : 0),
      legend: [0, 0.5, 1].map((t) => ({ colour: swatch(ramp(t)), text: `${short(t * most)} ${unit}` })),
    };
  };
  switch (by) {
    case "piece": {
      if (!piece) return { faces, edges: null, legend: [] };
      const names = [...new Set(piece.values())].sort();
      return named(names, (place) => names.indexOf(piece.get(model.faces[place]) ?? ""));
    }
    case "group": {
      const names = model.told.groups as string[];
      return named(names, (place) => model.group[place]);
    }
    case "planarity": {
      const { of, legend } = scale(model.planarity, "mm from planar");
      faces.forEach((_, i) => (faces[i] = of(model.planarity[i])));
      return { faces, edges: null, legend };
    }
    case "valence": {
      const [three, more] = [new Color(PALETTE[2]), new Color(PALETTE[6])];
      faces.forEach((_, i) => {
        const isThree = model.faceVertices(i).every((v) => model.valence[v] <= 3);
        faces[i] = isThree ? three : more;
      });
      const legend = [
        { colour: swatch(three), text: "three edges at every corner" },
        { colour: swatch(more), text: "more at some corner" },
      ];
      return { faces, edges: null, legend };
    }
    case "fold": {
      const folds = model.fold.map((x) => (Number.isNaN(x) ? 0 : Math.abs(x)));
      const { of, legend } = scale(folds, "° fold");
      return { faces, edges: Array.from(folds, of), legend };
    }
    default:
      return { faces, edges: null, legend: [] };
  }
}
