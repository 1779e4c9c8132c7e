// Reads GLB files with the validator of the Khronos Group and FOLD files with the library of the format's
// authors. usage: node check.mjs FILE.glb|FILE.fold ...
// A GLB must give no error and no warning. Of a FOLD file the library counts vertices, edges and faces, and
// finds the faces again from nothing but where the edges of the flat pattern lie.

import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url);
const validator = require("gltf-validator");
const FOLD = require("fold");

async function glb(path) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(path)));
  const { numErrors, numWarnings, messages } = report.issues;
  const told = messages.slice(0, 3).map((m) => `${m.code} at ${m.pointer}: ${m.message}`);
  return numErrors + numWarnings === 0 ? [] : told;
}

async function fold(path) {
  const file = JSON.parse(await readFile(path, "utf8"));
  const faults = [];
  const count = { vertices: "numVertices", edges: "numEdges", faces: "numFaces" };
  for (const [kind, ask] of Object.entries(count)) {
    const listed = file[kind === "vertices" ? "vertices_coords" : `${kind}_vertices`].length;
    const counted = FOLD.filter[ask](file);
    if (counted !== listed) faults.push(`${counted} ${kind}, ${listed} in the file`);
  }
  const flat = { vertices_coords: file.vertices_coords, edges_vertices: file.edges_vertices };
  const found = FOLD.convert.edges_vertices_to_faces_vertices(FOLD.convert.deepCopy(flat));
  const name = (face) => {
    const first = face.indexOf(Math.min(...face));
    return [...face.slice(first), ...face.slice(0, first)].join(" ");
  };
  const [ours, theirs] = [file.faces_vertices, found.faces_vertices].map((f) => new Set(f.map(name)));
  const other = [...ours].filter((face) => !theirs.has(face));
  if (other.length > 0) faults.push(`${other.length} faces that the library does not find, first ${other[0]}`);
  return faults;
}

const files = process.argv.slice(2);
let bad = files.length === 0 ? ["no files were given"] : [];
for (const path of files) {
  const faults = await (path.endsWith(".glb") ? glb(path) : fold(path));
  bad.push(...faults.map((fault) => `${path}: ${fault}`));
}
bad.slice(0, 50).forEach((fault) => console.log("fault:", fault));
console.log(`${files.length} files read by the glTF validator and by FOLD: ${bad.length === 0 ? "as they should be" : "FAULTS"}`);
process.exitCode = bad.length === 0 ? 0 : 1;
