// A mesh as the studio sends it, with what the page asks of it.

import type { Arrays } from "./api";

export type Element = "vertex" | "edge" | "face";

export class Model {
  readonly positions: Float32Array;
  readonly faces: Uint32Array;
  readonly starts: Uint32Array;
  readonly corners: Uint32Array;
  readonly triangles: Uint32Array;
  readonly triangleFace: Uint32Array;
  readonly edges: Uint32Array;
  readonly ends: Uint32Array;
  readonly beside: Uint32Array;
  readonly fold: Float32Array;
  readonly planarity: Float32Array;
  readonly group: Uint32Array;
  readonly valence: Uint32Array;
  readonly origin: [number, number, number];
  readonly size: [number, number, number];
  readonly radius: number;
  /** Places by id; ids may have gaps. */
  readonly placeOfFace = new Map<number, number>();
  readonly placeOfEdge = new Map<number, number>();
  private sides: Map<number, number[]> | null = null;

  constructor(readonly arrays: Arrays) {
    this.positions = arrays.f32("positions");
    this.faces = arrays.u32("faces");
    this.starts = arrays.u32("face_starts");
    this.corners = arrays.u32("face_vertices");
    this.triangles = arrays.u32("triangles");
    this.triangleFace = arrays.u32("triangle_face");
    this.edges = arrays.u32("edges");
    this.ends = arrays.u32("edge_vertices");
    this.beside = arrays.u32("edge_faces");
    this.fold = arrays.f32("edge_fold");
    this.planarity = arrays.f32("face_planarity");
    this.group = arrays.u32("face_group");
    this.valence = arrays.u32("vertex_valence");
    this.origin = arrays.told.origin;
    this.size = arrays.told.size;
    this.radius = Math.hypot(...this.size) / 2 || 1;
    this.faces.forEach((id, place) => this.placeOfFace.set(id, place));
    this.edges.forEach((id, place) => this.placeOfEdge.set(id, place));
  }

  get told() {
    return this.arrays.told;
  }

  made(kind: Element | "strip"): number[] {
    const name = { vertex: "made_vertices", edge: "made_edges", face: "made_faces", strip: "made_strip" }[kind];
    return [...this.arrays.u32(name)];
  }

  vertex(id: number): [number, number, number] {
    return [this.positions[3 * id], this.positions[3 * id + 1], this.positions[3 * id + 2]];
  }

  faceVertices(place: number): Uint32Array {
    return this.corners.subarray(this.starts[place], this.starts[place + 1]);
  }

  /** The middle of an element, by its id. */
  middle(kind: Element, id: number): [number, number, number] | null {
    let corners: ArrayLike<number>;
    if (kind === "vertex") corners = [id];
    else if (kind === "edge") {
      const place = this.placeOfEdge.get(id);
      if (place === undefined) return null;
      corners = this.ends.subarray(2 * place, 2 * place + 2);
    } else {
      const place = this.placeOfFace.get(id);
      if (place === undefined) return null;
      corners = this.faceVertices(place);
    }
    const sum: [number, number, number] = [0, 0, 0];
    for (let i = 0; i < corners.length; i++) this.vertex(corners[i]).forEach((x, k) => (sum[k] += x / corners.length));
    return Number.isNaN(sum[0]) ? null : sum;
  }

  /** The edges of a face, by ids. */
  edgesOfFace(id: number): number[] {
    if (!this.sides) {
      this.sides = new Map();
      this.edges.forEach((edge, place) => {
        for (const face of this.beside.subarray(2 * place, 2 * place + 2)) {
          const list = this.sides!.get(face);
          if (list) list.push(edge);
          else this.sides!.set(face, [edge]);
        }
      });
    }
    return this.sides.get(id) ?? [];
  }

  ids(kind: Element): Uint32Array | number[] {
    if (kind === "edge") return this.edges;
    if (kind === "face") return this.faces;
    const ids: number[] = [];
    for (let i = 0; i < this.valence.length; i++) if (!Number.isNaN(this.positions[3 * i])) ids.push(i);
    return ids;
  }
}

/** Ids as a selection writes them: `3,7,10-14`. */
export function idsText(ids: Iterable<number>): string {
  const sorted = [...new Set(ids)].sort((a, b) => a - b);
  const runs: [number, number][] = [];
  for (const id of sorted) {
    const last = runs[runs.length - 1];
    if (last && last[1] + 1 === id) last[1] = id;
    else runs.push([id, id]);
  }
  return runs.map(([a, b]) => (a === b ? `${a}` : b === a + 1 ? `${a},${b}` : `${a}-${b}`)).join(",");
}
