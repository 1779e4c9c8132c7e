"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const about = document.getElementById("about");
const both = document.getElementById("both");
const parts = [...document.querySelectorAll(".part")];
const seams = [...document.querySelectorAll(".seam")];
let piece = -1, seam = -1;

// Lights a piece or a seam with its partners, everywhere.
function light(newPiece, newSeam) {
  if (newPiece === piece && newSeam === seam) return;
  piece = newPiece;
  seam = newSeam;
  const own = data.seams.map((s, i) => [s, i])
    .filter(([s, i]) => (seam >= 0 ? i === seam : s.pieces.includes(piece)));
  const mates = new Set(own.flatMap(([s]) => s.pieces));
  const lit = new Set(own.map(([, i]) => i));
  both.classList.toggle("some", piece >= 0 || seam >= 0);
  for (const part of parts) {
    const p = Number(part.dataset.p);
    const isLit = p === piece || (seam >= 0 && mates.has(p));
    part.classList.toggle("lit", isLit);
    part.classList.toggle("mate", !isLit && piece >= 0 && mates.has(p));
  }
  for (const s of seams) s.classList.toggle("lit", lit.has(Number(s.dataset.s)));
  const name = (p) => data.names[p];
  if (seam >= 0) {
    const s = data.seams[seam];
    about.textContent = `seam ${s.number}: ${s.pieces.map(name).join(" – ")}`;
  } else if (piece >= 0) {
    const list = own.map(([s]) => {
      const other = s.pieces[0] === piece ? s.pieces[1] : s.pieces[0];
      return `${s.number} to ${other === piece ? "itself" : name(other)}`;
    });
    about.textContent = name(piece) + (list.length ? `: seam ${list.join(", ")}` : "");
  } else {
    about.textContent = "\u00a0";
  }
  if (data.model) draw();
}

for (const part of parts) {
  part.addEventListener("pointerenter", () => light(Number(part.dataset.p), -1));
  part.addEventListener("pointerleave", () => light(-1, -1));
}
for (const s of seams) {
  s.addEventListener("pointerenter", () => light(-1, Number(s.dataset.s)));
  s.addEventListener("pointerleave", () => light(-1, -1));
}

// The model, drawn with a depth buffer of its own: what is in front hides what is behind.
const canvas = document.getElementById("model");
let turn = -0.48, tilt = 0.53, shown = null;

function project() {
  const [ct, st, cu, su] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
  const scale = Math.min(canvas.width, canvas.height) * 0.00047;
  return (x, y, z) => {
    const right = x * ct - y * st, away = x * st + y * ct;
    const up = away * su + z * cu, near = z * su - away * cu;
    return [canvas.width / 2 + right * scale, canvas.height / 2 - up * scale, near];
  };
}

function draw() {
  const m = data.model, { width, height } = canvas;
  const to = project();
  const at = [];
  for (let i = 0; i < m.points.length; i += 3) at.push(to(m.points[i], m.points[i + 1], m.points[i + 2]));
  const depth = new Float32Array(width * height).fill(-1e9);
  const face = new Int32Array(width * height).fill(-1);
  const shade = new Float32Array(width * height);
  for (let t = 0; t < m.face.length; t++) {
    fill(at[m.triangles[3 * t]], at[m.triangles[3 * t + 1]], at[m.triangles[3 * t + 2]], m.face[t]);
  }
  function fill(a, b, c, id) {
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if (Math.abs(area) < 1e-9) return;
    const k = Math.min(canvas.width, canvas.height) * 0.00047;
    // The normal from the two depths: light from the upper left.
    const u = [(b[0] - a[0]) / k, (a[1] - b[1]) / k, b[2] - a[2]];
    const v = [(c[0] - a[0]) / k, (a[1] - c[1]) / k, c[2] - a[2]];
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const size = Math.hypot(...n) * (n[2] < 0 ? -1 : 1);
    n = n.map((x) => x / size);
    const lit = 0.74 + 0.26 * Math.max(0, -0.45 * n[0] + 0.62 * n[1] + 0.64 * n[2]);
    const [x0, x1] = [Math.min(a[0], b[0], c[0]), Math.max(a[0], b[0], c[0])];
    const [y0, y1] = [Math.min(a[1], b[1], c[1]), Math.max(a[1], b[1], c[1])];
    for (let y = Math.max(0, Math.ceil(y0 - 0.5)); y + 0.5 <= y1 && y < height; y++) {
      for (let x = Math.max(0, Math.ceil(x0 - 0.5)); x + 0.5 <= x1 && x < width; x++) {
        const p = x + 0.5, q = y + 0.5;
        const s = ((p - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (q - a[1])) / area;
        const r = ((b[0] - a[0]) * (q - a[1]) - (p - a[0]) * (b[1] - a[1])) / area;
        if (s < 0 || r < 0 || s + r > 1) continue;
        const d = a[2] + s * (b[2] - a[2]) + r * (c[2] - a[2]);
        const i = y * width + x;
        if (d > depth[i]) { depth[i] = d; face[i] = id; shade[i] = n[2] > 0 && area < 0 ? lit : lit * 0.8; }
      }
    }
  }
  paint(face, shade);
  shown = face;
  seamLines(to, depth);
}

function paint(face, shade) {
  const { width, height } = canvas, context = canvas.getContext("2d");
  const image = context.createImageData(width, height), m = data.model;
  const mates = new Set(data.seams.filter((s, i) => (seam >= 0 ? i === seam : s.pieces.includes(piece)))
    .flatMap((s) => s.pieces));
  const any = piece >= 0 || seam >= 0;
  for (let i = 0; i < face.length; i++) {
    let colour = [251, 250, 248];
    if (face[i] >= 0) {
      const p = m.piece[face[i]];
      const pale = any && p !== piece && !mates.has(p) ? 0.65 : 0;
      colour = data.colours[p].map((c) => c * shade[i] * (1 - pale) + 245 * pale);
    }
    // An edge is where the next face begins; seams are darker than folds.
    for (const j of [i + 1, i + width]) {
      if (j < face.length && face[j] !== face[i]) {
        const same = face[i] >= 0 && face[j] >= 0 && m.piece[face[i]] === m.piece[face[j]];
        colour = colour.map((c) => c * (same ? 0.72 : 0.3));
        break;
      }
    }
    image.data.set([...colour, 255], 4 * i);
  }
  context.putImageData(image, 0, 0);
}

// Seams that are lit, where they are not hidden.
function seamLines(to, depth) {
  if (piece < 0 && seam < 0) return;
  const context = canvas.getContext("2d");
  context.strokeStyle = "#111";
  context.lineWidth = 5;
  context.lineCap = "round";
  data.seams.forEach((s, i) => {
    if (seam >= 0 ? i !== seam : !s.pieces.includes(piece)) return;
    for (const e of s.seams.map((k) => data.model.seams[k])) {
      if (!e) continue;
      const [a, b] = [to(...e.slice(0, 3)), to(...e.slice(3))];
      const middle = [0, 1, 2].map((k) => (a[k] + b[k]) / 2);
      const x = Math.round(middle[0]), y = Math.round(middle[1]);
      let isSeen = false;
      for (let dy = -3; dy <= 3; dy++) for (let dx = -3; dx <= 3; dx++) {
        isSeen ||= middle[2] > depth[(y + dy) * canvas.width + x + dx] - 12;
      }
      if (!isSeen) continue;
      context.beginPath();
      context.moveTo(a[0], a[1]);
      context.lineTo(b[0], b[1]);
      context.stroke();
    }
  });
}

if (data.model) {
  let from = null;
  canvas.addEventListener("pointerdown", (event) => {
    from = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointerup", () => (from = null));
  canvas.addEventListener("pointerleave", () => light(-1, -1));
  canvas.addEventListener("pointermove", (event) => {
    if (from) {
      turn += (event.clientX - from[0]) * 0.008;
      tilt = Math.max(-1.57, Math.min(1.57, tilt + (event.clientY - from[1]) * 0.008));
      from = [event.clientX, event.clientY];
      requestAnimationFrame(draw);
      return;
    }
    const box = canvas.getBoundingClientRect();
    const x = Math.floor((event.clientX - box.left) / box.width * canvas.width);
    const y = Math.floor((event.clientY - box.top) / box.height * canvas.height);
    const face = shown ? shown[y * canvas.width + x] : -1;
    light(face >= 0 ? data.model.piece[face] : -1, -1);
  });
  draw();
}
