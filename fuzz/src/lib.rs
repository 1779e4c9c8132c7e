//! The bodies of the fuzz targets: what holds for any bytes whatever.
//!
//! A reader refuses a file or takes it, and never panics. What it takes is sound, and what kerfold
//! writes of it is read back as the same. Each body panics where that does not hold.

use std::path::Path;

use kerfold::io::order_json::Order;
use kerfold::io::pieces_json::{read_pieces_json, write_pieces_json};
use kerfold::io::planes_csv::parse_planes;
use kerfold::io::{
    IoError, MeshFormat, ReadOptions, WriteOptions, artwork, decode_text, mesh_bytes,
    read_mesh_bytes, read_points_bytes, read_seams_bytes,
};
use kerfold::mesh::{Mesh, assert_sound};
use kerfold::op::{
    HandleParams, HullParams, MengerParams, OpContext, Operate, RindParams, Scheme, ShellSource,
    SierpinskiParams, SubdivideParams, Thickness, TruncateEdgeParams, TruncateFaceParams,
    TruncateVertexParams,
};
use kerfold::recipe::Recipe;
use kerfold::select::{Context, Selection};
use kerfold::shape;
use kerfold::units::{Angle, Length};

/// The name of a target and its body.
pub type Target = (&'static str, fn(&[u8]));

/// All targets that read a file.
pub const READERS: &[Target] = &[
    ("obj", obj),
    ("off", off),
    ("heights", heights),
    ("ply", ply),
    ("stl", stl),
    ("glb", glb),
    ("3mf", threemf),
    ("planes", planes),
    ("points", points),
    ("seams", seams),
    ("pieces", pieces),
    ("order", order),
    ("recipe", recipe),
    ("select", select),
    ("svg", svg),
    ("dxf", dxf),
    ("pdf", pdf),
];

/// Wavefront OBJ.
pub fn obj(bytes: &[u8]) {
    mesh_file("x.obj", bytes);
}

/// Object File Format.
pub fn off(bytes: &[u8]) {
    mesh_file("x.off", bytes);
}

/// Heights over a grid, as CSV.
pub fn heights(bytes: &[u8]) {
    mesh_file("x.csv", bytes);
}

/// Stanford PLY.
pub fn ply(bytes: &[u8]) {
    mesh_file("x.ply", bytes);
}

/// STL.
pub fn stl(bytes: &[u8]) {
    mesh_file("x.stl", bytes);
}

/// Binary glTF.
pub fn glb(bytes: &[u8]) {
    mesh_file("x.glb", bytes);
}

/// 3MF: the model in its zip, and a zip of its own.
pub fn threemf(bytes: &[u8]) {
    mesh_file("x.3mf", bytes);
}

fn mesh_file(name: &str, bytes: &[u8]) {
    let plain = ReadOptions::default();
    let Ok(read) = read_mesh_bytes(Path::new(name), bytes, &plain) else { return };
    assert_sound(&read.mesh);
    read.notes.iter().for_each(|note| assert!(!note.to_string().is_empty()));
    same_after_files(&read.mesh, name, false);
    let welding = ReadOptions { weld: Some(Length::from_mm(0.1)), ..plain };
    if let Ok(welded) = read_mesh_bytes(Path::new(name), bytes, &welding) {
        assert_sound(&welded.mesh);
    }
}

/// Writes a mesh in the formats that keep every digit and reads it back; returns whether files can
/// hold it. Self-loops and faces of two sides, which operators may leave for the next, are no part of
/// files, and what comes of a mesh with such may be refused when it is written, with a reason.
fn same_after_files(mesh: &Mesh, what: &str, is_of_unfinished: bool) -> bool {
    let is_loop = |h| mesh.origin(h) == mesh.target(h);
    let is_simple =
        !mesh.edges().any(|e| is_loop(e.half_edge())) && mesh.faces().all(|f| mesh.sides(f) > 2);
    let expected = if is_simple { Some(mesh.counts()) } else { mesh.file_counts() };
    for (format, name) in
        [(MeshFormat::Obj, "x.obj"), (MeshFormat::Ply, "x.ply"), (MeshFormat::Off, "x.off")]
    {
        let bytes = match mesh_bytes(format, mesh, &WriteOptions::default()) {
            Ok(bytes) => bytes,
            Err(IoError::NotForFiles { .. }) if !is_simple || is_of_unfinished => return false,
            Err(error) => panic!("{what}: {name}: {error}"),
        };
        let back = read_mesh_bytes(Path::new(name), &bytes, &ReadOptions::default());
        let back = back
            .unwrap_or_else(|error| panic!("{what}: {name} was written and is refused: {error}"));
        assert_eq!(Some(back.mesh.counts()), expected, "{what}: {name}");
        assert_eq!(back.mesh.bounds(), mesh.bounds(), "{what}: {name}");
    }
    is_simple
}

/// Half-spaces as CSV.
pub fn planes(bytes: &[u8]) {
    if let Ok(text) = decode_text(bytes)
        && let Ok(planes) = parse_planes(&text, Path::new("planes.csv"))
    {
        assert_eq!(planes.half_spaces.len(), planes.lines.len());
    }
}

/// Points of a polyline, as a list and as OBJ.
pub fn points(bytes: &[u8]) {
    for name in ["points.txt", "points.obj"] {
        if let Ok(points) = read_points_bytes(Path::new(name), bytes) {
            assert!(!points.is_empty() && points.iter().all(|p| p.is_finite()));
        }
    }
}

/// Seams of a cube, as a list and as OBJ.
pub fn seams(bytes: &[u8]) {
    let cube = shape::cube(10.0);
    for name in ["seams.txt", "seams.obj"] {
        if let Ok(edges) = read_seams_bytes(Path::new(name), bytes, &cube, &[]) {
            assert!(edges.is_sorted() && edges.iter().all(|&e| cube.has_edge(e)));
        }
    }
}

/// `pieces.json`.
pub fn pieces(bytes: &[u8]) {
    let Ok(text) = decode_text(bytes) else { return };
    if let Ok((net, command)) = read_pieces_json(&text) {
        let again = read_pieces_json(&write_pieces_json(&net, &command)).expect("written by us");
        assert_eq!(again, (net, command));
    }
}

/// Pieces to be nested.
pub fn order(bytes: &[u8]) {
    let Ok(text) = decode_text(bytes) else { return };
    let mut order = Order::default();
    if order.add(&text, 1).is_ok() {
        assert_eq!(order.net.pieces.len(), order.sources.len());
    }
}

/// Recipes.
pub fn recipe(bytes: &[u8]) {
    let Ok(text) = decode_text(bytes) else { return };
    match Recipe::parse(&text) {
        Ok(recipe) => assert!(!recipe.steps.is_empty()),
        Err(error) => {
            let lines = text.split('\n').count();
            assert!(error.at().is_none_or(|at| (1..=lines).contains(&at.line)), "{error}");
        }
    }
}

/// Texts of selections, evaluated on a cube.
pub fn select(bytes: &[u8]) {
    let cube = shape::cube(10.0);
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(selection) = text.parse::<Selection>() else { return };
    let context = Context::of(&cube);
    if let Ok(edges) = selection.edges(&context) {
        assert!(edges.is_sorted() && edges.iter().all(|&e| cube.has_edge(e)));
    }
    if let Ok(faces) = selection.faces(&context) {
        assert!(faces.is_sorted() && faces.iter().all(|&f| cube.has_face(f)));
    }
}

/// SVG drawings.
pub fn svg(bytes: &[u8]) {
    drawing("x.svg", bytes);
}

/// DXF drawings.
pub fn dxf(bytes: &[u8]) {
    drawing("x.dxf", bytes);
}

/// PDF drawings.
pub fn pdf(bytes: &[u8]) {
    drawing("x.pdf", bytes);
}

fn drawing(name: &str, bytes: &[u8]) {
    if let Ok((_, pages)) = artwork::read_artwork(Path::new(name), bytes) {
        let points = pages.iter().flat_map(|page| &page.paths).flat_map(|path| &path.points);
        points.for_each(|p| assert!(p.is_finite(), "a point that is not finite"));
    }
}

/// Faces beyond which a chain of operators ends.
const MOST_FACES: usize = 600;
/// Operators in a chain.
const MOST_STEPS: usize = 6;

/// Choices that come from bytes, and are all zero after the last of them.
struct Choices<'a>(std::slice::Iter<'a, u8>);

impl Choices<'_> {
    fn below(&mut self, count: usize) -> usize {
        self.0.next().map_or(0, |&byte| usize::from(byte)) % count
    }

    /// Some of the numbers of elements, by their places among `all`.
    fn some(&mut self, all: &[u32]) -> Selection {
        let count = 1 + self.below(3);
        let chosen = (0..count).map(|_| {
            let place = self.below(256) * 256 + self.below(256);
            all[place % all.len()]
        });
        let mut ids: Vec<u32> = chosen.collect();
        ids.sort_unstable();
        ids.dedup();
        let ids: Vec<String> = ids.iter().map(u32::to_string).collect();
        ids.join(",").parse().expect("numbers with commas are a selection")
    }

    fn share(&mut self) -> f64 {
        [0.2, 0.05, 0.3, 0.5, 0.9, 1e-3, -0.2][self.below(7)]
    }
}

/// Chains of operators. After every step the mesh is sound, and its files are read as the same.
pub fn chains(bytes: &[u8]) {
    let mut choices = Choices(bytes.iter());
    let mut mesh = match choices.below(6) {
        0 => shape::tetrahedron(20.0),
        1 => shape::cube(20.0),
        2 => shape::octahedron(20.0),
        3 => shape::prism(5, 20.0),
        4 => shape::antiprism(4, 20.0),
        _ => shape::dodecahedron(20.0),
    };
    let mut done: Vec<String> = Vec::new();
    let mut is_of_unfinished = false;
    for _ in 0..MOST_STEPS {
        if choices.0.len() == 0 || mesh.face_count() > MOST_FACES {
            return;
        }
        let Some(operator) = operator(&mut choices, &mesh) else { return };
        let Ok(output) = operator.operate(&mesh, &OpContext::default()) else { continue };
        assert_sound(&output.mesh);
        done.push(format!("{operator:?}"));
        is_of_unfinished |=
            !same_after_files(&output.mesh, &done.join(", then "), is_of_unfinished);
        mesh = output.mesh;
    }
}

fn operator(choices: &mut Choices<'_>, mesh: &Mesh) -> Option<Box<dyn Operate>> {
    let vertices: Vec<u32> = mesh.vertices().map(|v| v.index() as u32).collect();
    let edges: Vec<u32> = mesh.edges().map(|e| e.index() as u32).collect();
    let faces: Vec<u32> = mesh.faces().map(|f| f.index() as u32).collect();
    if faces.is_empty() {
        return None;
    }
    Some(match choices.below(10) {
        0 => Box::new(TruncateVertexParams::new(choices.some(&vertices), choices.share())),
        1 => Box::new(TruncateEdgeParams::new(choices.some(&edges), choices.share())),
        2 => Box::new(TruncateFaceParams::new(choices.some(&faces), choices.share())),
        3 | 4 => Box::new(SubdivideParams::new(scheme(choices), 1)),
        5 => Box::new(SierpinskiParams { rounds: 1 }),
        6 => {
            let thickness = Thickness::Share(choices.share().abs());
            Box::new(MengerParams { thickness, ..MengerParams::default() })
        }
        7 => Box::new(RindParams {
            thickness: Length::from_mm(10.0 * choices.share()),
            thickness_of: Vec::new(),
            punch: (choices.below(2) == 0).then(|| choices.some(&faces)),
            peel: (choices.below(2) == 0).then(|| choices.some(&faces)),
            shell: [ShellSource::New, ShellSource::Given][choices.below(2)],
        }),
        8 => {
            let mut face = || faces[choices.below(256) % faces.len()].to_string().parse().ok();
            Box::new(HandleParams {
                from: face()?,
                to: face()?,
                segments: 1 + choices.below(4) as u32,
                also: Vec::new(),
                axis: None,
                weights: None,
                twist: Angle::from_degrees(90.0 * choices.below(3) as f64),
            })
        }
        _ => Box::new(HullParams {
            dual: choices.below(2) == 1,
            simple: choices.below(2) == 1,
            ..HullParams::default()
        }),
    })
}

fn scheme(choices: &mut Choices<'_>) -> Scheme {
    const SCHEMES: [Scheme; 8] = [
        Scheme::DooSabin,
        Scheme::CatmullClark,
        Scheme::Loop,
        Scheme::Simplest,
        Scheme::Honeycomb,
        Scheme::Truncation,
        Scheme::Dual,
        Scheme::Triangulate,
    ];
    SCHEMES[choices.below(SCHEMES.len())]
}
