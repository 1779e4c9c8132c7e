// The drawn model: what is seen, what is under the pointer, what is marked.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { MeshBVH, acceleratedRaycast } from "three-mesh-bvh";
import type { Arrays } from "./api";
import { type ColourBy, type Painted, paint } from "./colours";
import type { Element, Model } from "./model";

export interface Marks {
  kind: Element;
  ids: Set<number>;
}

/** Takes everything out of a group and gives its memory back. */
function clear(group: THREE.Object3D) {
  for (const child of [...group.children] as THREE.Mesh[]) {
    group.remove(child);
    child.geometry?.dispose();
    // Materials are not disposed of: with the last of a kind its compiled program would go, too.
    clear(child);
  }
}

/** How near to an edge or a vertex the pointer must be, in pixels. */
const CLOSE = 12;

const COLOURS = {
  light: { ground: 0xf6f7f9, edge: 0x39424e, ghost: 0x8a94a1, accent: 0x1769c4, bad: 0xc62828, hover: 0xe08600, cap: 0x6aa8e8 },
  dark: { ground: 0x171b21, edge: 0x0b0e12, ghost: 0x7d8896, accent: 0x63a9ff, bad: 0xff6b61, hover: 0xffb547, cap: 0x3f7fc4 },
};

export class View {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(28, 1, 0.1, 1000);
  readonly controls: OrbitControls;
  private readonly body = new THREE.Group();
  private readonly over = new THREE.Group();
  /** What is picked: the faces of the base model, drawn or not. */
  private solid: THREE.Mesh | null = null;
  private solidOf: Model | null = null;
  private bvh: MeshBVH | null = null;
  private base: Model | null = null;
  private shown: Model | null = null;
  private marks: Marks = { kind: "edge", ids: new Set() };
  private bad = new Set<number>();
  private hovered: { kind: Element; id: number }[] = [];
  private waiting = false;
  private isDark = false;
  private film: THREE.Object3D | null = null;
  isXray = false;
  colourBy: ColourBy = "plain";
  piece: Map<number, string> | null = null;
  onlegend: (painted: Painted) => void = () => {};

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.enableDamping = false;
    this.controls.screenSpacePanning = true;
    const sky = new THREE.HemisphereLight(0xffffff, 0x9aa3ad, 1.6);
    sky.position.set(0, 0, 1);
    const sun = new THREE.DirectionalLight(0xffffff, 1.7);
    sun.position.set(-0.5, 0.7, 1.2);
    // The light goes with the eye, so that no side is ever black.
    this.camera.add(sun);
    this.scene.add(sky, this.camera, this.body, this.over);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  private get colours() {
    return this.isDark ? COLOURS.dark : COLOURS.light;
  }

  theme(isDark: boolean) {
    this.isDark = isDark;
    this.scene.background = new THREE.Color(this.colours.ground);
    this.rebuild();
  }

  private resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement!;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.renderNow();
    });
  }

  renderNow() {
    this.renderer.render(this.scene, this.camera);
  }

  home() {
    const radius = (this.base ?? this.shown)?.radius ?? 1;
    const far = (0.95 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.camera.position.set(0.62, -0.86, 0.52).setLength(far);
    this.camera.near = far / 100;
    this.camera.far = far * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.set(0, 0, 0);
    this.controls.update();
    this.draw();
  }

  /** The model on which elements are marked, and what is drawn in its place while a step is tried. */
  show(base: Model | null, preview: Model | null = null, bad: number[] = []) {
    const before = this.base;
    this.base = base;
    this.shown = preview ?? base;
    this.bad = new Set(bad);
    this.rebuild();
    if (base && (!before || Math.abs(Math.log(before.radius / base.radius)) > 0.7)) this.home();
  }

  mark(marks: Marks) {
    this.marks = marks;
    this.overlay();
  }

  hover(elements: { kind: Element; id: number }[]) {
    this.hovered = elements;
    this.overlay();
  }

  /** Draws the model anew: after a change of it, of its colours, of the theme. */
  rebuild() {
    clear(this.body);
    if (this.solidOf !== this.base) {
      this.solidOf = this.base;
      this.solid?.geometry.dispose();
      this.solid = null;
      this.bvh = null;
      if (this.base) {
        this.solid = new THREE.Mesh(this.geometry(this.base, null));
        this.solid.raycast = acceleratedRaycast;
      }
    }
    const model = this.shown;
    if (model) {
      const painted = paint(model, this.colourBy, this.isDark, this.piece);
      const isPreview = model !== this.base;
      if (isPreview) {
        const cap = new THREE.Color(this.bad.size ? this.colours.bad : this.colours.cap);
        for (const id of model.made("face")) {
          const place = model.placeOfFace.get(id);
          if (place !== undefined) painted.faces[place] = cap;
        }
      }
      this.onlegend(painted);
      const material = new THREE.MeshLambertMaterial({
        vertexColors: true,
        side: THREE.DoubleSide,
        transparent: this.isXray,
        opacity: this.isXray ? 0.45 : 1,
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
      });
      this.body.add(new THREE.Mesh(this.geometry(model, painted.faces), material));
      this.body.add(this.lines(model, painted.edges, this.colours.edge, 1));
      if (isPreview && this.base) {
        this.body.add(this.lines(this.base, null, this.colours.ghost, 0.35));
        this.planes(model);
      }
    }
    this.overlay();
  }

  private geometry(model: Model, colours: THREE.Color[] | null) {
    const count = model.triangles.length;
    const position = new Float32Array(3 * count);
    const colour = colours ? new Float32Array(3 * count) : null;
    for (let i = 0; i < count; i++) {
      const v = 3 * model.triangles[i];
      position[3 * i] = model.positions[v];
      position[3 * i + 1] = model.positions[v + 1];
      position[3 * i + 2] = model.positions[v + 2];
      if (colour) {
        const c = colours![model.triangleFace[(i / 3) | 0]];
        colour[3 * i] = c.r;
        colour[3 * i + 1] = c.g;
        colour[3 * i + 2] = c.b;
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    if (colour) {
      geometry.setAttribute("color", new THREE.BufferAttribute(colour, 3));
      geometry.setAttribute("normal", new THREE.BufferAttribute(normals(position), 3));
    }
    return geometry;
  }

  private lines(model: Model, colours: THREE.Color[] | null, colour: number, opacity: number) {
    const position = new Float32Array(3 * model.ends.length);
    const coloured = colours ? new Float32Array(3 * model.ends.length) : null;
    for (let i = 0; i < model.ends.length; i++) {
      position.set(model.positions.subarray(3 * model.ends[i], 3 * model.ends[i] + 3), 3 * i);
      if (coloured) colours![i >> 1].toArray(coloured, 3 * i);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    if (coloured) geometry.setAttribute("color", new THREE.BufferAttribute(coloured, 3));
    const material = new THREE.LineBasicMaterial({
      color: coloured ? 0xffffff : colour,
      vertexColors: coloured !== null,
      transparent: opacity < 1,
      opacity,
    });
    return new THREE.LineSegments(geometry, material);
  }

  /** The planes of a cut beyond their caps, while there are few of them. */
  private planes(model: Model) {
    const caps = model.made("face");
    if (caps.length > 60) return;
    const position: number[] = [];
    for (const id of caps) {
      const place = model.placeOfFace.get(id);
      const middle = model.middle("face", id);
      if (place === undefined || !middle) continue;
      const corners = [...model.faceVertices(place)].map((v) => {
        const p = model.vertex(v);
        return p.map((x, k) => middle[k] + 1.25 * (x - middle[k]));
      });
      corners.forEach((p, i) => position.push(...middle, ...p, ...corners[(i + 1) % corners.length]));
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
    const material = new THREE.MeshBasicMaterial({
      color: this.bad.size ? this.colours.bad : this.colours.accent,
      transparent: true,
      opacity: 0.16,
      side: THREE.DoubleSide,
      depthWrite: false,
    });
    this.body.add(new THREE.Mesh(geometry, material));
  }

  /** Marks and hints over the model. */
  private overlay() {
    clear(this.over);
    const { kind, ids } = this.marks;
    const good = [...ids].filter((id) => !this.bad.has(id));
    const bad = [...ids].filter((id) => this.bad.has(id));
    this.highlight(kind, good, this.colours.accent, 4);
    this.highlight(kind, bad, this.colours.bad, 5);
    for (const element of ["vertex", "edge", "face"] as const) {
      const own = this.hovered.filter((one) => one.kind === element).map((one) => one.id);
      this.highlight(element, own, this.colours.hover, 6);
    }
    this.draw();
  }

  private highlight(kind: Element, ids: number[], colour: number, width: number) {
    const model = this.base;
    if (!model || !ids.length) return;
    const depthTest = !this.isXray;
    if (kind === "edge") {
      const position: number[] = [];
      for (const id of ids) {
        const place = model.placeOfEdge.get(id);
        if (place === undefined) continue;
        position.push(...model.vertex(model.ends[2 * place]), ...model.vertex(model.ends[2 * place + 1]));
      }
      if (!position.length) return;
      const geometry = new LineSegmentsGeometry().setPositions(position);
      const material = new LineMaterial({ color: colour, linewidth: width, depthTest });
      material.polygonOffset = true;
      material.polygonOffsetFactor = -2;
      material.polygonOffsetUnits = -2;
      this.over.add(new LineSegments2(geometry, material));
      return;
    }
    const position: number[] = [];
    if (kind === "vertex") {
      for (const id of ids) if (id < model.valence.length) position.push(...model.vertex(id));
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
      const material = new THREE.PointsMaterial({ color: colour, size: 2.5 * width, sizeAttenuation: false, depthTest });
      material.polygonOffset = true;
      material.polygonOffsetFactor = -4;
      this.over.add(new THREE.Points(geometry, material));
      return;
    }
    const places = new Set(ids.map((id) => model.placeOfFace.get(id)));
    model.triangleFace.forEach((place, t) => {
      if (places.has(place)) for (let k = 0; k < 3; k++) position.push(...model.vertex(model.triangles[3 * t + k]));
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
    const material = new THREE.MeshBasicMaterial({
      color: colour,
      side: THREE.DoubleSide,
      transparent: true,
      opacity: 0.55,
      depthTest,
      polygonOffset: true,
      polygonOffsetFactor: -1,
      polygonOffsetUnits: -1,
    });
    this.over.add(new THREE.Mesh(geometry, material));
  }

  /** The pieces on their way to the closed model, or nothing of it. */
  showFilm(arrays: Arrays | null) {
    if (this.film) {
      this.scene.remove(this.film);
      clear(this.film);
    }
    this.film = null;
    this.body.visible = this.over.visible = !arrays;
    if (arrays) {
      const corners = arrays.f32("corners");
      const triangles = arrays.u32("triangles");
      const ofFace = arrays.u32("triangle_face");
      const faces = arrays.u32("faces");
      const starts = arrays.u32("face_starts");
      const position = new Float32Array(3 * triangles.length);
      const colour = new Float32Array(3 * triangles.length);
      const model = this.base!;
      const painted = paint(model, "piece", this.isDark, this.piece);
      triangles.forEach((corner, i) => {
        position.set(corners.subarray(3 * corner, 3 * corner + 3), 3 * i);
        const place = model.placeOfFace.get(faces[ofFace[(i / 3) | 0]]);
        (painted.faces[place ?? 0] ?? new THREE.Color(0xcccccc)).toArray(colour, 3 * i);
      });
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
      geometry.setAttribute("color", new THREE.BufferAttribute(colour, 3));
      geometry.computeVertexNormals();
      const outline: number[] = [];
      for (let f = 0; f + 1 < starts.length; f++) {
        for (let i = starts[f]; i < starts[f + 1]; i++) {
          const next = i + 1 < starts[f + 1] ? i + 1 : starts[f];
          for (const c of [i, next]) outline.push(corners[3 * c], corners[3 * c + 1], corners[3 * c + 2]);
        }
      }
      const lines = new THREE.BufferGeometry();
      lines.setAttribute("position", new THREE.Float32BufferAttribute(outline, 3));
      this.film = new THREE.Group().add(
        new THREE.Mesh(
          geometry,
          new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }),
        ),
        new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: this.colours.edge })),
      );
      // Flat pieces spread wider than the body; all of them are seen.
      geometry.computeBoundingSphere();
      const { center, radius } = geometry.boundingSphere!;
      const scale = Math.min(1, (0.9 * model.radius) / radius);
      this.film.scale.setScalar(scale);
      this.film.position.copy(center).multiplyScalar(-scale);
      this.scene.add(this.film);
    }
    this.draw();
  }

  // ---- what is under the pointer ----------------------------------------------------------------

  private ray(x: number, y: number) {
    const caster = new THREE.Raycaster();
    caster.firstHitOnly = true;
    const box = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
    caster.setFromCamera(place, this.camera);
    return caster;
  }

  private hit(caster: THREE.Raycaster): { face: number; distance: number } | null {
    if (!this.solid || !this.base?.triangles.length) return null;
    if (!this.bvh) {
      this.bvh = new MeshBVH(this.solid.geometry, { indirect: true });
      (this.solid.geometry as any).boundsTree = this.bvh;
    }
    (this.solid.material as THREE.Material).side = THREE.DoubleSide;
    this.solid.updateMatrixWorld();
    const [hit] = caster.intersectObject(this.solid, false);
    if (!hit || hit.faceIndex === undefined || hit.faceIndex === null) return null;
    return { face: this.base.triangleFace[hit.faceIndex], distance: hit.distance };
  }

  /** Where a point of the model is on the page. */
  toPage(point: ArrayLike<number>): { x: number; y: number; depth: number } {
    const p = new THREE.Vector3(point[0], point[1], point[2]).project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + ((p.x + 1) / 2) * box.width, y: box.top + ((1 - p.y) / 2) * box.height, depth: p.z };
  }

  /** Whether nothing of the model is before a point of it. */
  isSeen(point: ArrayLike<number>): boolean {
    if (this.isXray) return true;
    const at = this.toPage(point);
    const hit = this.hit(this.ray(at.x, at.y));
    const distance = this.camera.position.distanceTo(new THREE.Vector3(point[0], point[1], point[2]));
    return !hit || hit.distance > distance - 0.004 * (this.base?.radius ?? 1);
  }

  /** The element of a kind under a place of the page; what is hidden is not picked. */
  pick(kind: Element, x: number, y: number): number | null {
    const model = this.base;
    if (!model) return null;
    if (kind === "face") {
      const hit = this.hit(this.ray(x, y));
      return hit ? model.faces[hit.face] : null;
    }
    const near: { id: number; distance: number; point: number[] }[] = [];
    const consider = (id: number, a: number[], b: number[]) => {
      const [p, q] = [this.toPage(a), this.toPage(b)];
      const [dx, dy] = [q.x - p.x, q.y - p.y];
      const length = dx * dx + dy * dy;
      const t = length ? Math.min(1, Math.max(0, ((x - p.x) * dx + (y - p.y) * dy) / length)) : 0;
      const distance = Math.hypot(x - p.x - t * dx, y - p.y - t * dy);
      if (distance <= CLOSE) near.push({ id, distance, point: a.map((c, k) => c + t * (b[k] - c)) });
    };
    const hit = this.isXray ? null : this.hit(this.ray(x, y));
    if (kind === "vertex") {
      const ids = hit ? model.faceVertices(hit.face) : model.ids("vertex");
      for (const id of ids) consider(id, model.vertex(id), model.vertex(id));
    } else {
      const ids = hit ? model.edgesOfFace(model.faces[hit.face]) : model.edges;
      for (const id of ids) {
        const place = model.placeOfEdge.get(id)!;
        consider(id, model.vertex(model.ends[2 * place]), model.vertex(model.ends[2 * place + 1]));
      }
    }
    near.sort((a, b) => a.distance - b.distance || a.id - b.id);
    return near.find((one) => hit !== null || this.isSeen(one.point))?.id ?? null;
  }

  /** The elements of a kind whose middles lie in a box of the page and are seen. */
  pickBox(kind: Element, box: { left: number; right: number; top: number; bottom: number }): number[] {
    const model = this.base;
    if (!model) return [];
    const found: number[] = [];
    for (const id of model.ids(kind)) {
      const middle = model.middle(kind, id);
      if (!middle) continue;
      const p = this.toPage(middle);
      const isIn = p.x >= box.left && p.x <= box.right && p.y >= box.top && p.y <= box.bottom && p.depth < 1;
      if (isIn && this.isSeen(middle)) found.push(id);
    }
    return found;
  }

  picture(): Promise<Blob | null> {
    this.renderNow();
    return new Promise((done) => this.canvas.toBlob(done, "image/png"));
  }
}

/** Every triangle looks straight out of its own plane: faces are flat. */
function normals(position: Float32Array) {
  const normal = new Float32Array(position.length);
  for (let i = 0; i < position.length; i += 9) {
    const [ax, ay, az] = [position[i + 3] - position[i], position[i + 4] - position[i + 1], position[i + 5] - position[i + 2]];
    const [bx, by, bz] = [position[i + 6] - position[i], position[i + 7] - position[i + 1], position[i + 8] - position[i + 2]];
    const [x, y, z] = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
    const length = Math.hypot(x, y, z) || 1;
    for (let k = 0; k < 9; k += 3) {
      normal[i + k] = x / length;
      normal[i + k + 1] = y / length;
      normal[i + k + 2] = z / length;
    }
  }
  return normal;
}
