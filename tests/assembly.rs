//! The order of assembly of models that the unfolder laid out: every seam is closed once, pieces
//! are attached before anything is closed, and closing goes on like a zip.

use std::collections::BTreeSet;

use kerfold::geom::polygon::signed_area;
use kerfold::net::{Net, PieceId};
use kerfold::progress::Silent;
use kerfold::shape::{SolidParams, solid};
use kerfold::sheet::assembly_of;
use kerfold::unfold::{MeshSource, Seams, UnfoldParams, unfold};

fn net_of(name: &str, pieces: &str) -> Net {
    let name = name.parse().expect("a known solid");
    let mesh = solid(&SolidParams { name, edge: None, size: None }).expect("a solid");
    let params =
        UnfoldParams { pieces: pieces.parse().expect("a mode"), ..UnfoldParams::default() };
    unfold(&mesh, &Seams::Free, &params, &MeshSource { scale: 1.0, split_vertices: &[] }, &Silent)
        .expect("a net")
}

/// What every order must keep, by plain counting.
fn assert_order(net: &Net) {
    let assembly = assembly_of(net);
    let mut numbers: Vec<usize> = assembly.steps.iter().map(|s| s.number).collect();
    numbers.sort_unstable();
    assert_eq!(
        numbers,
        (1..=assembly.stretches.len()).collect::<Vec<_>>(),
        "every stretch is closed once"
    );
    let attaching = assembly.steps.iter().take_while(|s| s.attaches.is_some()).count();
    assert!(
        assembly.steps[attaching..].iter().all(|s| s.attaches.is_none()),
        "nothing is attached to what is being closed"
    );
    // These models are one body.
    assert_eq!(attaching, net.pieces.len() - 1);
    let mut there: BTreeSet<PieceId> = BTreeSet::new();
    for step in &assembly.steps[..attaching] {
        let sides = assembly.stretches[step.number - 1].pieces;
        let new = step.attaches.expect("an attaching step");
        let old = if sides[0] == new { sides[1] } else { sides[0] };
        assert!(sides.contains(&new) && old != new && !there.contains(&new), "{new} is new");
        assert!(there.is_empty() || there.contains(&old), "{new} is attached to what is there");
        there.extend(sides);
    }
    // Closing goes on like a zip: where nothing else is open at one end, as long as there is
    // such a place.
    let vertices = |number: usize| -> BTreeSet<usize> {
        assembly.stretches[number - 1].seams.iter().flat_map(|&(s, _)| net.seams[s].edge).collect()
    };
    let mut open: Vec<usize> = assembly.steps.iter().map(|s| s.number).collect();
    for (i, step) in assembly.steps.iter().enumerate() {
        let zips = |&number: &usize| {
            let others: Vec<BTreeSet<usize>> =
                open.iter().filter(|&&n| n != number).map(|&n| vertices(n)).collect();
            vertices(number).iter().any(|v| others.iter().all(|o| !o.contains(v)))
        };
        let stuck = !open.iter().any(zips);
        assert!(i < attaching || zips(&step.number) || stuck, "step {} leaves a zip", i + 1);
        open.retain(|&n| n != step.number);
    }
}

#[test]
fn every_piece_is_attached_before_anything_is_closed_and_then_it_is_zipped() {
    for (name, pieces) in [
        ("cube", "1"),
        ("cube", "2"),
        ("dodecahedron", "faces"),
        ("soccer-ball", "1"),
        ("soccer-ball", "4"),
        ("antiprism-9", "2"),
        ("snub-cube", "strips"),
    ] {
        assert_order(&net_of(name, pieces));
    }
}

#[test]
fn the_largest_piece_comes_first() {
    let net = net_of("prism-7", "faces");
    let assembly = assembly_of(&net);
    let area = |id: PieceId| signed_area(&net.pieces[id.0].outline);
    let first = assembly.stretches[assembly.steps[0].number - 1].pieces;
    let largest = net.pieces.iter().map(|p| area(p.id)).fold(0.0, f64::max);
    assert!(first.iter().any(|&id| area(id) == largest));
}

#[test]
fn one_piece_is_only_closed() {
    let assembly = assembly_of(&net_of("cube", "1"));
    assert!(assembly.steps.iter().all(|s| s.attaches.is_none()));
}
