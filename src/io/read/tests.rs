//! Readers from the file to the mesh.

use super::*;
use crate::mesh::VertexId;
use crate::mesh::assert_sound;
use clap::Parser as _;
use glam::DVec3;

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n\
    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

fn options(units: MeshUnit, size: Option<f64>, weld: Option<f64>) -> ReadOptions {
    ReadOptions {
        units,
        size: size.map(Length::from_mm),
        weld: weld.map(Length::from_mm),
        ..ReadOptions::default()
    }
}

fn read_text(text: &str, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    read_mesh_bytes(Path::new("model.obj"), text.as_bytes(), options)
}

/// Every face with corners of its own.
fn torn_cube() -> String {
    let read = read_text(CUBE, &ReadOptions::default()).expect("a cube");
    let mut text = String::new();
    for f in read.mesh.faces() {
        for p in read.mesh.face_positions(f) {
            text += &format!("v {} {} {}\n", p.x, p.y, p.z);
        }
        text += "f -4 -3 -2 -1\n";
    }
    text
}

#[derive(Debug, clap::Parser)]
struct Command {
    #[command(flatten)]
    read: ReadOptions,
}

#[test]
fn the_defaults_are_the_same_everywhere() {
    let by_flags = Command::parse_from(["x"]).read;
    let by_recipe: ReadOptions = toml::from_str("").expect("all optional");
    let shown = |options: &ReadOptions| format!("{options:?}");
    assert_eq!(shown(&by_flags), shown(&ReadOptions::default()));
    assert_eq!(shown(&by_recipe), shown(&ReadOptions::default()));
    let by_flags =
        Command::parse_from(["x", "--units", "in", "--size", "30cm", "--weld", "0"]).read;
    let by_recipe: ReadOptions =
        toml::from_str("units = 'in'\nsize = '30cm'\nweld = 0").expect("options");
    assert_eq!(shown(&by_flags), shown(&by_recipe));
}

#[test]
fn units_and_size_scale_and_a_factor_of_one_touches_nothing() {
    let moved = CUBE.replace("v 1", "v 0.30000000000000004");
    let size = |options: &ReadOptions| {
        let read = read_text(&moved, options).expect("a box");
        let (low, high) = read.mesh.bounds().expect("vertices");
        (read.scale, high - low)
    };
    let exact = 0.30000000000000004;
    assert_eq!(size(&options(MeshUnit::Mm, None, None)), (1.0, DVec3::new(exact, 1., 1.)));
    assert_eq!(
        size(&options(MeshUnit::In, None, None)),
        (25.4, DVec3::new(exact * 25.4, 25.4, 25.4))
    );
    assert_eq!(size(&options(MeshUnit::M, Some(300.0), None)).1.max_element(), 300.0);
    assert!(matches!(
        read_text(CUBE, &options(MeshUnit::Mm, Some(0.0), None)),
        Err(IoError::BadSize { .. })
    ));
}

#[test]
fn a_torn_surface_is_a_fault_and_welding_closes_it() {
    let torn = torn_cube();
    let error = read_text(&torn, &ReadOptions::default()).expect_err("torn");
    assert!(matches!(error, IoError::Torn { rim_edges: 24, .. }), "{error}");
    assert!(error.to_string().ends_with("; weld them with --weld 0"), "{error}");
    for distance in [0.0, 0.5] {
        let read = read_text(&torn, &options(MeshUnit::Mm, None, Some(distance))).expect("welded");
        assert_sound(&read.mesh);
        assert!(read.mesh.is_closed());
        assert_eq!(
            (read.mesh.vertex_count(), read.mesh.edge_count(), read.mesh.face_count()),
            (8, 12, 6)
        );
        assert_eq!(read.notes, [ReadNote::Welded { count: 16 }]);
    }
    let nothing = read_text(&torn, &options(MeshUnit::Mm, None, Some(2.0)));
    assert!(matches!(nothing, Err(IoError::WeldedAway { .. })));
    assert!(matches!(
        read_text(&torn, &options(MeshUnit::Mm, None, Some(-1.0))),
        Err(IoError::BadWeld { .. })
    ));
}

#[test]
fn a_surface_torn_in_places_is_noted() {
    let open: String = torn_cube().lines().skip(5).map(|line| format!("{line}\n")).collect();
    let read = read_text(&open, &ReadOptions::default()).expect("an open box in five pieces");
    let [ReadNote::CoincidentRims { coincident: 16, rim_edges: 20, .. }] = read.notes[..] else {
        panic!("{:?}", read.notes)
    };
}

#[test]
fn welding_collapses_thin_faces_and_keeps_groups_and_seams_in_place() {
    // A box of which one edge is a sliver face wide.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv \
    1.001 1 0\nv 1.001 1 1\n\
        g sliver\nf 3 7 10 9\ng rest\nf 4 3 9 2 1\nf 5 6 10 7 8\nf 1 2 6 5\nf 2 9 10 6\ng back\nf 3 4 8 7\nf 4 1 5 8\n\
        g seam\nl 9 10\nl 3 9\n";
    let whole = read_text(text, &ReadOptions::default()).expect("a box");
    assert_eq!((whole.mesh.face_count(), whole.mesh.is_closed()), (7, true));
    let welded = read_text(text, &options(MeshUnit::Mm, None, Some(0.01))).expect("welded");
    assert_sound(&welded.mesh);
    assert_eq!((welded.mesh.face_count(), welded.mesh.is_closed()), (6, true));
    assert_eq!(
        welded.notes,
        [ReadNote::Welded { count: 2 }, ReadNote::DroppedFaces { count: 1, first: 0 }]
    );
    let groups: Vec<_> =
        welded.mesh.faces().map(|f| welded.mesh.group(f).unwrap_or_default()).collect();
    assert_eq!(groups, ["rest", "rest", "rest", "rest", "back", "back"]);
    let seams = welded.mesh.edges().filter(|&e| welded.mesh.is_seam(e)).collect::<Vec<_>>();
    assert_eq!(seams.len(), 1);
}

#[test]
fn vertices_that_are_split_or_unused_are_noted_and_seams_find_them() {
    let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 2 3 4\nf 2 5 6\ng \
    seam\nl 5 2\n";
    let read = read_text(text, &ReadOptions::default()).expect("a bow tie");
    let (first, centre) = (VertexId::new(0), VertexId::new(1));
    let split = ReadNote::SplitVertices { count: 1, first: centre };
    assert_eq!(read.notes, [split, ReadNote::UnusedVertices { count: 1, first }]);
    let seam = read.mesh.edges().find(|&e| read.mesh.is_seam(e)).expect("a seam");
    assert!(read.mesh.edge_vertices(seam).contains(&VertexId::new(4)));
}

#[test]
fn repair_takes_seams_along_and_leaves_out_those_without_an_edge() {
    // Corner 2 is there twice, and a seam is marked on its second copy; another lies on no edge.
    let text = CUBE.replace("f 1 3 4 2", "v 1 0 0\nf 1 3 4 9") + "g seam\nl 9 4\nl 1 8\n";
    let path = Path::new("cube.obj");
    let params = crate::mend::RepairParams::default();
    let read = repair_mesh_bytes(path, text.as_bytes(), &ReadOptions::default(), &params);
    let read = read.expect("a mark is no reason to refuse");
    assert!(read.mesh.is_closed());
    assert_eq!(read.mesh.edges().filter(|&e| read.mesh.is_seam(e)).count(), 1);
    assert!(read.notes.contains(&ReadNote::LostSeams { count: 1 }), "{:?}", read.notes);
}
