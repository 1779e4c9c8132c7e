//! What we write ourselves passes our own lint: ready-made solids with all joints at three sizes.
//! A share of them runs always, all of them with `KERFOLD_FULL=1`.

use std::path::Path;

use kerfold::io::artwork::read_artwork;
use kerfold::io::sheet::files::sheet_bytes;
use kerfold::lint::{LintParams, lint};
use kerfold::net::Net;
use kerfold::progress::Silent;
use kerfold::shape::{SolidParams, solid, solid_names};
use kerfold::sheet::{
    Joint, JointParams, LayerKind, NestParams, SheetFormat, SheetParams, SheetSet, SheetSize,
    StockParams, Substitute, lay_out,
};
use kerfold::unfold::{MeshSource, Seams, UnfoldParams, unfold};
use kerfold::units::Length;

/// Largest extents of the solids, in mm.
const SIZES: [f64; 3] = [60.0, 150.0, 400.0];

/// Of the plates of fingers and tabs, in mm.
const THICKNESS: f64 = 3.0;

const JOINTS: [(Joint, Option<Substitute>); 8] = [
    (Joint::None, None),
    (Joint::Flaps, None),
    (Joint::Rivets, None),
    (Joint::Stitch, None),
    (Joint::Fingers, None),
    (Joint::Fingers, Some(Substitute::Mitre)),
    (Joint::Tabs, None),
    (Joint::Tabs, Some(Substitute::Mitre)),
];

/// Whether everything is to be tried, which takes minutes.
fn is_full() -> bool {
    std::env::var_os("KERFOLD_FULL").is_some()
}

/// The names of all solids, each form once.
fn names() -> Vec<String> {
    let prisms = (3..=20).map(|n| format!("prism-{n}"));
    let antiprisms = (3..=9).map(|n| format!("antiprism-{n}"));
    let families = prisms.chain(antiprisms).chain(["geodesic-2".to_owned()]);
    let mut names: Vec<String> = solid_names().map(str::to_owned).chain(families).collect();
    names.sort();
    names.dedup();
    names
}

fn net(name: &str, size: f64) -> Net {
    // Boxes have their extents in their names.
    let [x, y, z] = [1.0, 2.0 / 3.0, 1.0 / 3.0].map(|share| (share * size).round());
    let is_box = name.starts_with("box-");
    let form = if is_box { format!("box-{x}x{y}x{z}") } else { name.to_owned() };
    let params = SolidParams {
        name: form.parse().unwrap_or_else(|e| panic!("{form}: {e}")),
        edge: None,
        size: (!is_box).then(|| Length::from_mm(size)),
    };
    let mesh = solid(&params).unwrap_or_else(|e| panic!("{name}: {e}"));
    let source = MeshSource { scale: 1.0, split_vertices: &[] };
    unfold(&mesh, &Seams::Free, &UnfoldParams::default(), &source, &Silent)
        .unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn params((kind, substitute): (Joint, Option<Substitute>), kerf: f64) -> SheetParams {
    let is_thick = matches!(kind, Joint::Fingers | Joint::Tabs);
    let thickness = is_thick.then(|| Length::from_mm(THICKNESS));
    SheetParams {
        stock: StockParams {
            sheet: SheetSize::of_mm(3000.0, 3000.0),
            kerf: Length::from_mm(kerf),
            ..StockParams::default()
        },
        joint: JointParams { kind, substitute, thickness, ..JointParams::default() },
        // Where pieces lie changes nothing of them.
        nest: NestParams { nest_effort: 0, ..NestParams::default() },
        ..SheetParams::default()
    }
}

/// What lint finds in the sheets, as text.
fn faults(set: &SheetSet, params: &SheetParams) -> Vec<String> {
    let limits = LintParams {
        thickness: params.joint.thickness,
        kerf: Some(params.stock.kerf),
        ..LintParams::default()
    };
    let mut faults = Vec::new();
    for drawing in &set.drawings {
        let bytes = sheet_bytes(drawing, SheetFormat::Svg, params, "kerfold");
        let (_, pages) = read_artwork(Path::new("sheet.svg"), &bytes).expect("a sheet of our own");
        let findings =
            pages.iter().flat_map(|page| lint(page, &limits).expect("a page of ours").findings);
        faults.extend(findings.map(|finding| format!("{finding:?}")));
    }
    faults
}

#[test]
fn all_joints_of_all_solids_pass_lint() {
    let mut faulty = Vec::new();
    for (i, name) in names().iter().enumerate() {
        for (j, size) in SIZES.into_iter().enumerate() {
            // Every third solid at one of the sizes, when not all are tried.
            if !is_full() && (i % 3 != 0 || (i / 3) % 3 != j) {
                continue;
            }
            let net = net(name, size);
            for (k, joint) in JOINTS.into_iter().enumerate() {
                let params = params(joint, if (i + j + k) % 2 == 0 { 0.0 } else { 0.2 });
                let set = lay_out(&net, &params)
                    .unwrap_or_else(|e| panic!("{name} {size} {joint:?}: {e}"));
                // Seams may leave holes that are narrow whatever the joint; the program says so.
                if set.report.narrow_holes > 0 {
                    assert!(size < 100.0, "{name} {size} {joint:?}: narrow holes in a large model");
                    continue;
                }
                let found = faults(&set, &params);
                if let Some(first) = found.first() {
                    faulty.push(format!("{name} {size} {joint:?}: {} × {first}", found.len()));
                }
            }
        }
    }
    assert!(faulty.is_empty(), "{} of our sheets fail:\n{}", faulty.len(), faulty.join("\n"));
}

/// Only the dashes of perforations and hinges have to stay open.
#[test]
fn cut_layers_hold_closed_paths() {
    for (name, kerf) in [("soccer-ball", 0.2), ("antiprism-9", 0.0), ("geodesic-2", 0.5)] {
        let net = net(name, 150.0);
        for joint in JOINTS {
            let set = lay_out(&net, &params(joint, kerf)).expect("a net of few faces");
            let is_cut = |kind| matches!(kind, LayerKind::CutInner | LayerKind::CutOuter);
            for mark in set.drawings[0].marks().filter(|m| is_cut(m.kind.layer())) {
                assert!(mark.strokes.iter().all(|s| s.closed), "{name} {joint:?}: {}", mark.id);
            }
        }
    }
}
