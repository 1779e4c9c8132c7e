//! Random chains of operators that change the genus, with subdivisions and cuts among them: sound
//! after every one.

use std::path::Path;

use kerfold::io::{ReadOptions, read_mesh};
use kerfold::measure::genus;
use kerfold::mesh::{EdgeId, FaceId, Mesh, VertexId, assert_sound};
use kerfold::op::{
    HandleParams, MengerParams, OpContext, Operate, RindParams, Scheme, ShellSource,
    SierpinskiParams, SubdivideParams, Thickness, TruncateEdgeParams, TruncateFaceParams,
    TruncateVertexParams, rind,
};
use kerfold::select::Selection;
use kerfold::shape;
use kerfold::units::{Angle, Length};

/// Seeds that are tried, operators in each, and edges beyond which a chain ends.
const SEEDS: u64 = 1000;
const STEPS: usize = 10;
const MOST_EDGES: usize = 1200;

struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % sides
    }

    fn one_of(&mut self, ids: &[u32]) -> u32 {
        ids[self.roll(ids.len())]
    }
}

fn faces(mesh: &Mesh) -> Vec<u32> {
    mesh.faces().map(|f| f.index() as u32).collect()
}

fn chosen(dice: &mut Dice, ids: &[u32], most: usize) -> Vec<usize> {
    let mut ids: Vec<u32> = (0..=dice.roll(most)).map(|_| dice.one_of(ids)).collect();
    ids.sort_unstable();
    ids.dedup();
    ids.into_iter().map(|id| id as usize).collect()
}

fn some_faces(dice: &mut Dice, ids: &[u32], most: usize) -> Option<Selection> {
    Selection::of_faces(chosen(dice, ids, most).into_iter().map(FaceId::new))
}

fn step(dice: &mut Dice, mesh: &Mesh) -> Box<dyn Operate> {
    let all = faces(mesh);
    match dice.roll(9) {
        0 => Box::new(SierpinskiParams { rounds: 1 }),
        1 => Box::new(MengerParams { thickness: Thickness::Share(0.2), ..MengerParams::default() }),
        2 | 3 => Box::new(RindParams {
            thickness: Length::from_mm([0.3, -0.3, 2.0][dice.roll(3)]),
            thickness_of: Vec::new(),
            punch: if dice.roll(2) == 0 { some_faces(dice, &all, 3) } else { None },
            peel: if dice.roll(2) == 0 { some_faces(dice, &all, 5) } else { None },
            shell: if dice.roll(3) == 0 { ShellSource::Given } else { ShellSource::New },
        }),
        4 | 5 => {
            let corner = |face: u32| face.to_string().parse().expect("a face");
            let (from, to) = (dice.one_of(&all), dice.one_of(&all));
            Box::new(HandleParams {
                from: corner(from),
                to: corner(to),
                segments: 1 + dice.roll(4) as u32,
                also: Vec::new(),
                axis: None,
                weights: None,
                twist: Angle::from_degrees(90.0 * dice.roll(3) as f64),
            })
        }
        6 => {
            let schemes = [
                Scheme::DooSabin,
                Scheme::CatmullClark,
                Scheme::Loop,
                Scheme::Simplest,
                Scheme::Dual,
            ];
            Box::new(SubdivideParams::new(schemes[dice.roll(schemes.len())], 1))
        }
        7 => Box::new(SubdivideParams::new(
            [Scheme::Honeycomb, Scheme::Truncation, Scheme::Triangulate][dice.roll(3)],
            1,
        )),
        _ => {
            let vertices: Vec<u32> = mesh.vertices().map(|v| v.index() as u32).collect();
            let edges: Vec<u32> = mesh.edges().map(|e| e.index() as u32).collect();
            let some = "at least one";
            match dice.roll(3) {
                0 => {
                    let ids = chosen(dice, &vertices, 3).into_iter().map(VertexId::new);
                    let select = Selection::of_vertices(ids).expect(some);
                    Box::new(TruncateVertexParams::new(select, 0.2))
                }
                1 => {
                    let ids = chosen(dice, &edges, 2).into_iter().map(EdgeId::new);
                    let select = Selection::of_edges(ids).expect(some);
                    Box::new(TruncateEdgeParams::new(select, 0.2))
                }
                _ => {
                    let select = some_faces(dice, &all, 2).expect(some);
                    Box::new(TruncateFaceParams::new(select, 0.2))
                }
            }
        }
    }
}

#[test]
fn random_chains_stay_sound() {
    let (mut done, mut refused) = (0, 0);
    for seed in 0..SEEDS {
        let mut dice = Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(1));
        let mut mesh = match dice.roll(5) {
            0 => shape::tetrahedron(20.0),
            1 => shape::cube(20.0),
            2 => shape::octahedron(20.0),
            3 => shape::prism(5, 20.0),
            _ => shape::antiprism(4, 20.0),
        };
        for _ in 0..STEPS {
            if mesh.edge_count() > MOST_EDGES {
                break;
            }
            let operator = step(&mut dice, &mesh);
            match operator.operate(&mesh, &OpContext::default()) {
                Ok(made) => {
                    assert!(
                        made.mesh.faults().is_empty(),
                        "seed {seed}: {operator:?}: {:?}",
                        made.mesh.faults().first()
                    );
                    done += 1;
                    mesh = made.mesh;
                }
                Err(_) => refused += 1,
            }
        }
        assert_sound(&mesh);
        assert_eq!(mesh.component_count(), mesh.components().len(), "seed {seed}");
    }
    assert!(done > 3 * SEEDS as usize && refused < done, "{done} done, {refused} refused");
}

/// A patch of faces around one, found side by side; `None` when it is no disc.
fn patch(mesh: &Mesh, start: FaceId, size: usize) -> Option<Vec<FaceId>> {
    let mut faces = vec![start];
    let mut next = 0;
    while faces.len() < size && next < faces.len() {
        for h in mesh.face_half_edges(faces[next]) {
            let beside = mesh.face(h.twin());
            if faces.len() < size && !faces.contains(&beside) {
                faces.push(beside);
            }
        }
        next += 1;
    }
    let mut vertices: Vec<VertexId> = faces.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
    let mut edges: Vec<_> =
        faces.iter().flat_map(|&f| mesh.face_half_edges(f)).map(|h| h.edge()).collect();
    vertices.sort_unstable();
    vertices.dedup();
    edges.sort_unstable();
    edges.dedup();
    (vertices.len() + faces.len() == edges.len() + 1).then_some(faces)
}

/// Patches that share no vertex, each a disc, leave one opening each when peeled; punched one by
/// one every face is an opening.
#[test]
fn rinds_of_spot_have_the_genus_of_their_openings() {
    let spot = read_mesh(Path::new("fixtures/meshes/spot-1000.obj"), &ReadOptions::default())
        .expect("Spot")
        .mesh;
    let all = faces(&spot);
    let mut dice = Dice(7);
    for _ in 0..40 {
        let mut is_used = vec![false; spot.vertex_slots()];
        let mut patches: Vec<Vec<FaceId>> = Vec::new();
        for _ in 0..12 {
            let size = 1 + dice.roll(9);
            let start = FaceId::new(dice.one_of(&all) as usize);
            let Some(found) = patch(&spot, start, size) else { continue };
            let corners: Vec<usize> =
                found.iter().flat_map(|&f| spot.face_vertices(f)).map(|v| v.index()).collect();
            if corners.iter().all(|&v| !is_used[v]) {
                corners.into_iter().for_each(|v| is_used[v] = true);
                patches.push(found);
            }
        }
        let chosen = Selection::of_faces(patches.iter().flatten().copied());
        let count = patches.iter().map(Vec::len).sum::<usize>();
        for (punch, peel, openings) in
            [(None, chosen.clone(), patches.len()), (chosen, None, count)]
        {
            let thickness = Length::from_mm([0.002, -0.002][dice.roll(2)]);
            let params = RindParams {
                thickness,
                thickness_of: Vec::new(),
                punch,
                peel,
                shell: ShellSource::New,
            };
            let (made, report) = rind(&spot, &params, &OpContext::default()).expect("a rind");
            assert_sound(&made);
            assert_eq!((made.component_count(), genus(&made)), (1, openings - 1), "{report:?}");
        }
    }
}
