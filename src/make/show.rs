//! How a fabrication is shown: pieces that fold themselves up, and the steps of assembly as
//! pictures.

use std::collections::{BTreeSet, HashMap};
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::ValueEnum;
use glam::{DQuat, DVec2, DVec3};
use serde::{Deserialize, Deserializer};

use super::assembly_text::Engraved;
use super::outputs::Output;
use super::{Fabrication, MakeError};
use crate::bloom::{Bloom, FlatPlace, FoldTree, Leaf, Pose, state_mesh};
use crate::code::codes;
use crate::io::bloom_fold::fold_text;
use crate::io::bloom_glb::bloom_scene;
use crate::io::glb::glb_bytes;
use crate::measure::face_area;
use crate::mesh::{FaceId, Mesh};
use crate::net::{EdgeLabel, Net};
use crate::picture::{Cell, Colour, RenderParams, UpAxis, render_strip};
use crate::sheet::{Assembly, AssemblyStep, Labels, Layout};

/// Moments of a strip of the animation, in seconds: flat, five of folding, two of moving.
const MOMENTS: [f64; 8] = [0.0, 1.2, 1.9, 2.6, 3.3, 4.0, 5.0, 6.0];

/// Pictures in a row, and in the picture of a page.
const COLUMNS: usize = 4;
const PAGE: usize = 12;

/// How far folds are turned that no closed seam holds yet.
const LOOSE: f64 = 0.4;

/// What is made to be looked at.
#[derive(Debug, Clone, PartialEq, Default, clap::Args, Deserialize)]
pub struct ShowParams {
    /// The pieces folding themselves up from flat to closed: an animation (.glb), a strip of
    /// pictures (.png), or crease pattern and closed form for origami programs (.fold)
    #[arg(long, value_name = "FILE")]
    #[serde(default)]
    pub animate: Option<AnimationFile>,
    /// How the order of assembly is shown: as a list, or as pictures too (assembly-01.png, …,
    /// twelve steps each)
    #[arg(long, value_enum, default_value = "list")]
    #[serde(default)]
    pub assembly: AssemblyForm,
}

/// How the order of assembly is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AssemblyForm {
    /// assembly.txt, which is written with the sheets.
    #[default]
    List,
    /// A picture of every step as well.
    Pictures,
}

/// A file for the animation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnimationFile {
    path: PathBuf,
    form: AnimationForm,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AnimationForm {
    Glb,
    Png,
    Fold,
}

/// A name that does not say which kind of animation is meant.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` names no animation; name the file something.glb, something.png for a strip of \
    pictures, or something.fold for origami programs"
)]
pub struct AnimationFileError {
    /// What was typed.
    pub text: String,
}

codes!(error struct AnimationFileError = 752);

impl FromStr for AnimationFile {
    type Err = AnimationFileError;
    fn from_str(text: &str) -> Result<Self, AnimationFileError> {
        let path = PathBuf::from(text);
        let is =
            |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
        let form = match (is("glb"), is("png"), is("fold")) {
            (true, ..) => AnimationForm::Glb,
            (_, true, _) => AnimationForm::Png,
            (.., true) => AnimationForm::Fold,
            _ => return Err(AnimationFileError { text: text.to_owned() }),
        };
        Ok(Self { path, form })
    }
}

impl fmt::Display for AnimationFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.path.display().fmt(f)
    }
}

impl<'de> Deserialize<'de> for AnimationFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

impl ShowParams {
    /// The same with the file of the animation named from the working folder instead of the folder
    /// of the results.
    pub fn from_here(&self) -> Self {
        let absolute = |file: &AnimationFile| {
            let path = std::path::absolute(&file.path).unwrap_or_else(|_| file.path.clone());
            AnimationFile { path, form: file.form }
        };
        Self { animate: self.animate.as_ref().map(absolute), ..self.clone() }
    }
}

/// The files that were asked for. `mesh` is the one that was unfolded, in mm; `labels` is what is
/// engraved, and `render` says how pictures look.
///
/// # Errors
/// [`MakeError`] when a picture cannot be drawn, or a number does not fit into the file.
pub fn show_outputs(
    fabrication: &Fabrication,
    mesh: &Mesh,
    (show, labels): (&ShowParams, Labels),
    render: &RenderParams,
    command: &str,
) -> Result<Vec<Output>, MakeError> {
    let mut outputs = Vec::new();
    let render = RenderParams { colour: Colour::Group, height: None, ..render.clone() };
    if let Some(file) = &show.animate {
        let name = file.path.to_string_lossy().into_owned();
        let places = flat_places(&fabrication.sheets.layout);
        let bloom = Bloom::new(&fabrication.net, &places, corners(mesh));
        let bytes = match file.form {
            AnimationForm::Glb => glb_bytes(&bloom_scene(&bloom, &stem(&file.path)), command)?,
            AnimationForm::Png => strip_of(&bloom, &render)?,
            AnimationForm::Fold => {
                fold_text(&bloom, corners(mesh), &stem(&file.path), command).into_bytes()
            }
        };
        outputs.push((name, bytes));
    }
    if show.assembly == AssemblyForm::Pictures {
        outputs.extend(assembly_pictures(fabrication, labels, mesh, &render)?);
    }
    Ok(outputs)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn corners(mesh: &Mesh) -> impl Fn(usize) -> Option<Vec<DVec3>> {
    |face| Some(mesh.face_positions(FaceId::new(face)))
}

/// Where the sheets have the pieces, in mm and radians, the sheets side by side with a tenth of their
/// width in between: where a film of closing begins.
pub fn flat_places(layout: &Layout) -> Vec<FlatPlace> {
    let mut left = 0.0;
    let mut places = Vec::new();
    for sheet in &layout.sheets {
        places.extend(sheet.placed.iter().map(|placed| FlatPlace {
            piece: placed.piece,
            rotation: placed.rotation.to_radians(),
            shift: DVec2::new(left + placed.x, placed.y),
        }));
        left += 1.1 * sheet.width;
    }
    places
}

/// The pieces as they lie on the sheets, side by side, as a mesh in the plane z = 0: each face in
/// the group of its piece, with the groups of `names` in their order.
///
/// # Errors
/// [`MakeError::State`] for a net that is not one of a mesh.
pub fn flat_mesh(fabrication: &Fabrication, names: &[String]) -> Result<Mesh, MakeError> {
    let net = &fabrication.net;
    let places = flat_places(&fabrication.sheets.layout);
    let bloom = Bloom::new(net, &places, |_| None);
    let group = |leaf: &Leaf| {
        let id = net.pieces[leaf.piece].id.to_string();
        names.iter().position(|name| *name == id)
    };
    state_mesh(bloom.tree(), &bloom.at(0.0), |_| false, names, group).map_err(MakeError::State)
}

/// The animation as a strip of pictures, a colour for every piece.
fn strip_of(bloom: &Bloom<'_>, render: &RenderParams) -> Result<Vec<u8>, MakeError> {
    let names: Vec<String> = bloom.tree().net().pieces.iter().map(|p| p.id.to_string()).collect();
    let mut cells = Vec::new();
    for (i, seconds) in (1..).zip(MOMENTS) {
        let mesh = state_mesh(
            bloom.tree(),
            &bloom.at(seconds),
            |_| false,
            &names,
            |leaf| Some(leaf.piece),
        )
        .map_err(MakeError::State)?;
        cells.push(Cell { mesh, label: i.to_string() });
    }
    Ok(render_strip(&cells, COLUMNS as u32, render)?.to_png())
}

/// Pages of pictures: what is assembled by then, what the step moves in another colour, open edges
/// marked.
fn assembly_pictures(
    fabrication: &Fabrication,
    labels: Labels,
    mesh: &Mesh,
    render: &RenderParams,
) -> Result<Vec<Output>, MakeError> {
    let assembly = &fabrication.sheets.assembly;
    let engraved = Engraved::new(fabrication, labels);
    let mut bench = Bench::new(&fabrication.net, mesh, assembly);
    let mut view = Turntable::new(mesh, render)?;
    let mut outputs = Vec::new();
    for (page, groups) in (1..).zip(assembly.together().chunks(PAGE)) {
        let mut cells = Vec::new();
        for (steps, number) in groups.iter().zip((page - 1) * PAGE + 1..) {
            let label = format!("{number}  {}", engraved.label(steps));
            let mut mesh = bench.close(steps)?;
            view.turn(&mut mesh);
            cells.push(Cell { mesh, label });
        }
        let columns = COLUMNS.min(cells.len()) as u32;
        let render =
            RenderParams { width: render.width / COLUMNS as u32 * columns, ..render.clone() };
        outputs.push((
            format!("assembly-{page:02}.png"),
            render_strip(&cells, columns, &render)?.to_png(),
        ));
    }
    Ok(outputs)
}

/// Turns the work on the bench so that what is joined can be seen: by eighths of a turn, as it is
/// or upside down.
struct Turntable {
    eye: DVec3,
    middle: DVec3,
    turns: Vec<DQuat>,
    now: usize,
}

/// The work stays as it lies while it shows at least this share of what could be seen at best.
const WELL_SEEN: f64 = 0.6;

impl Turntable {
    fn new(mesh: &Mesh, render: &RenderParams) -> Result<Self, MakeError> {
        let up = if render.up == UpAxis::Z { DVec3::Z } else { DVec3::Y };
        let eighth = |i: usize| DQuat::from_axis_angle(up, i as f64 * std::f64::consts::FRAC_PI_4);
        let over = DQuat::from_rotation_x(std::f64::consts::PI);
        let turns = [DQuat::IDENTITY, over]
            .into_iter()
            .flat_map(|q| (0..8).map(move |i| eighth(i) * q))
            .collect();
        let (low, high) = mesh.bounds().unwrap_or_default();
        Ok(Self { eye: render.eye()?, middle: low.midpoint(high), turns, now: 0 })
    }

    fn turn(&mut self, mesh: &mut Mesh) {
        let new = mesh.faces().filter(|&f| mesh.group(f) == Some(NAMES[1]));
        let normals: Vec<DVec3> = new
            .filter_map(|f| mesh.plane(f).map(|plane| plane.normal() * face_area(mesh, f)))
            .collect();
        let seen =
            |turn: &DQuat| normals.iter().map(|&n| (*turn * n).dot(self.eye).max(0.0)).sum::<f64>();
        let shares: Vec<f64> = self.turns.iter().map(seen).collect();
        let best = shares.iter().copied().fold(0.0, f64::max);
        if shares[self.now] < WELL_SEEN * best {
            self.now = shares.iter().position(|&s| s == best).unwrap_or(self.now);
        }
        let vertices: Vec<_> = mesh.vertices().collect();
        for v in vertices {
            let p = self.middle + self.turns[self.now] * (mesh.position(v) - self.middle);
            mesh.set_position(v, p, false);
        }
    }
}

/// The groups of a picture of assembly.
const NAMES: [&str; 2] = ["done", "new"];

/// What lies on the bench while the seams are closed one after the other.
struct Bench<'a> {
    assembly: &'a Assembly,
    mesh: &'a Mesh,
    tree: FoldTree<'a>,
    /// Leaf → whether a closed seam holds its hinge at its full angle.
    is_held: Vec<bool>,
    closed: BTreeSet<EdgeLabel>,
    /// Pieces in use by now, by their places in the net.
    used: BTreeSet<usize>,
}

impl<'a> Bench<'a> {
    fn new(net: &'a Net, mesh: &'a Mesh, assembly: &'a Assembly) -> Self {
        // A piece hangs on the middle of the stretch along which it is attached.
        let attaching = assembly.steps.iter().filter(|s| s.attaches.is_some());
        let joined: Vec<usize> = attaching
            .map(|step| {
                let seams = &assembly.stretches[step.number - 1].seams;
                seams[seams.len() / 2].0
            })
            .collect();
        let tree = FoldTree::new(net, &joined);
        let is_held = vec![false; tree.leaves().len()];
        Self { assembly, mesh, tree, is_held, closed: BTreeSet::new(), used: BTreeSet::new() }
    }

    /// Closes some stretches and looks at the body that the last belongs to.
    fn close(&mut self, steps: &[AssemblyStep]) -> Result<Mesh, MakeError> {
        let net = self.tree.net();
        let places: HashMap<_, usize> =
            net.pieces.iter().enumerate().map(|(i, p)| (p.id, i)).collect();
        let before = self.poses();
        let mut touched = BTreeSet::new();
        for step in steps {
            let stretch = &self.assembly.stretches[step.number - 1];
            self.used.extend(stretch.pieces.iter().filter_map(|id| places.get(id)));
            for &(s, _) in &stretch.seams {
                let seam = &net.seams[s];
                self.closed.insert(seam.id);
                let [Some(a), Some(b)] = [0, 1].map(|k| self.tree.place_of(seam.sides[k].face))
                else {
                    continue;
                };
                touched.extend([a, b]);
                for leaf in self.tree.way(a, b).into_iter().flatten() {
                    self.is_held[leaf] = true;
                }
            }
        }
        let attached = steps.iter().find_map(|s| s.attaches);
        let attached = attached.and_then(|id| places.get(&id).copied());
        self.look(&touched, attached, &before)
    }

    /// Where every leaf lies by now.
    fn poses(&self) -> Vec<Pose> {
        let corners = corners(self.mesh);
        let root = |leaf: &Leaf| {
            let face = self.tree.flat(leaf);
            corners(face.face)
                .and_then(|points| Pose::fit(&face.polygon, &points))
                .unwrap_or(Pose::IDENTITY)
        };
        self.tree.poses(root, |leaf, _| if self.is_held[leaf] { 1.0 } else { LOOSE })
    }

    /// The leaves that lie elsewhere than before by more than rounding.
    fn moved(&self, before: &[Pose], now: &[Pose]) -> BTreeSet<usize> {
        let (low, high) = self.mesh.bounds().unwrap_or_default();
        let least = 1e-6 * low.distance(high);
        let has_moved = |&i: &usize| {
            let flat = &self.tree.flat(&self.tree.leaves()[i]).polygon;
            flat.iter().any(|&p| before[i].lift(p).distance(now[i].lift(p)) > least)
        };
        (0..now.len()).filter(has_moved).collect()
    }

    fn look(
        &self,
        touched: &BTreeSet<usize>,
        attached: Option<usize>,
        before: &[Pose],
    ) -> Result<Mesh, MakeError> {
        let poses = self.poses();
        let moved = self.moved(before, &poses);
        // What closes without moving is shown by the faces at its seam.
        let moving = if moved.is_empty() { touched } else { &moved };
        let leaves = self.tree.leaves();
        let body = touched.first().map(|&leaf| leaves[leaf].root);
        let is_new = |leaf: &Leaf| match attached {
            Some(piece) => leaf.piece == piece,
            None => self
                .tree
                .place_of(self.tree.flat(leaf).face)
                .is_some_and(|place| moving.contains(&place)),
        };
        let group = |leaf: &Leaf| {
            let is_shown = Some(leaf.root) == body && self.used.contains(&leaf.piece);
            is_shown.then(|| usize::from(is_new(leaf)))
        };
        let names = NAMES.map(str::to_owned);
        state_mesh(&self.tree, &poses, |edge| self.closed.contains(&edge), &names, group)
            .map_err(MakeError::State)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn animations_are_named_by_their_kind() {
        assert_eq!("a/b.GLB".parse::<AnimationFile>().map(|f| f.form), Ok(AnimationForm::Glb));
        assert_eq!("b.png".parse::<AnimationFile>().map(|f| f.form), Ok(AnimationForm::Png));
        assert_eq!("b.Fold".parse::<AnimationFile>().map(|f| f.form), Ok(AnimationForm::Fold));
        for bad in ["", "glb", "b.gltf", "b"] {
            assert!(
                bad.parse::<AnimationFile>().expect_err(bad).to_string().contains("something.glb")
            );
        }
    }

    #[test]
    fn the_last_picture_of_assembly_is_the_model_and_each_step_closes_more() {
        let params = crate::shape::SolidParams {
            name: "snub-cube".parse().expect("a solid"),
            edge: None,
            size: None,
        };
        let mesh = crate::shape::solid(&params).expect("a solid");
        let source = crate::unfold::MeshSource { scale: 1.0, split_vertices: &[] };
        for pieces in ["1", "3"] {
            let unfold = crate::unfold::UnfoldParams {
                pieces: pieces.parse().expect("a number"),
                ..Default::default()
            };
            let silent = crate::progress::Silent;
            let net = crate::unfold::unfold(
                &mesh,
                &crate::unfold::Seams::Free,
                &unfold,
                &source,
                &silent,
            );
            let net = net.expect("a net");
            let assembly = crate::sheet::assembly_of(&net);
            let mut bench = Bench::new(&net, &mesh, &assembly);
            let mut open = usize::MAX;
            let mut last = None;
            for step in &assembly.steps {
                let state = bench.close(std::slice::from_ref(step)).expect("a state");
                crate::mesh::assert_sound(&state);
                assert!(state.faces().any(|f| state.group(f) == Some("new")));
                let rims = state.edges().filter(|&e| state.is_rim(e)).count();
                // Attaching brings new rims. Closing takes some, unless both ends were closed
                // before: then the sides met already.
                assert!(step.attaches.is_some() || rims <= open, "{rims} of {open}");
                open = rims;
                last = Some(state);
            }
            let mut last = last.expect("steps");
            let volume = crate::measure::volume(&last);
            Turntable::new(&mesh, &RenderParams::default()).expect("a view").turn(&mut last);
            assert!(
                (volume - crate::measure::volume(&last)).abs() < 1e-9 * volume,
                "turning keeps the model"
            );
            assert!(last.is_closed());
            assert_eq!(last.face_count(), mesh.face_count());
            let volume = crate::measure::volume(&last);
            assert!((volume - crate::measure::volume(&mesh)).abs() < 1e-9 * volume, "{volume}");
        }
    }
}
