//! All choices of folds of a solid as small pictures, so that one can be picked by eye: the carved
//! body, and beside it its pieces, laid flat and turned towards whoever looks, in the same colours.

use glam::{DVec2, DVec3};

use super::carve::{CarvedDform, carve_folds};
use super::{DformParams, MakeError};
use crate::mesh::{EdgeId, FaceId, Mesh, MeshBuilder};
use crate::net::Net;
use crate::op::RollOptions;
use crate::picture::{Cell, Colour, Projection, RenderParams, UpAxis, render_strip};
use crate::progress::Progress;
use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};

/// More choices than this no picture can show; the first ones are drawn.
pub const MOST_CHOICES: usize = 60;
/// Pictures in a row, and the width of each in pixels.
const COLUMNS: usize = 3;
const CELL: u32 = 480;
/// Strips of each fold: enough to look smooth at this size.
const STRIPS: u32 = 4;

/// A choice of folds with the words that stand on its picture.
#[derive(Debug, Clone)]
pub struct FoldChoice {
    /// What stands in the corner.
    pub label: String,
    /// The folds, one at every vertex.
    pub folds: Vec<EdgeId>,
}

/// Draws the choices in rows, as a PNG. A choice that cannot be carved is drawn as it is before, with
/// a sharp sign behind its label.
///
/// # Errors
/// [`MakeError`] when a choice cannot be unfolded, or the picture cannot be drawn.
pub fn choices_picture(
    mesh: &Mesh,
    choices: &[FoldChoice],
    progress: &dyn Progress,
) -> Result<Vec<u8>, MakeError> {
    let shown = &choices[..choices.len().min(MOST_CHOICES)];
    let render = RenderParams {
        width: CELL * COLUMNS.min(shown.len().max(1)) as u32,
        height: Some(CELL / 2),
        colour: Colour::Group,
        projection: Projection::Parallel,
        ..RenderParams::default()
    };
    let mut cells = Vec::new();
    for (i, choice) in shown.iter().enumerate() {
        progress.report("drawing choices", i, shown.len());
        if progress.is_cancelled() {
            return Err(crate::op::OpError::Cancelled.into());
        }
        cells.push(cell(mesh, choice, &render, progress)?);
    }
    let columns = COLUMNS.min(cells.len().max(1)) as u32;
    Ok(render_strip(&cells, columns, &render)?.to_png())
}

fn cell(
    mesh: &Mesh,
    choice: &FoldChoice,
    render: &RenderParams,
    progress: &dyn Progress,
) -> Result<Cell, MakeError> {
    let rolling = RollOptions { strips: Some(STRIPS), ..RollOptions::default() };
    let params = DformParams { rolling, ..DformParams::default() };
    let (carved, sign) =
        match carve_folds(mesh, vec![choice.folds.clone()], (&params, None), progress) {
            Ok(carved) => (carved, ""),
            Err(_) => (CarvedDform::uncarved(mesh, &choice.folds), " #"),
        };
    let seams = Seams::Folds(carved.folds.clone());
    let source = MeshSource::default();
    let net = unfold(&carved.mesh, &seams, &UnfoldParams::default(), &source, progress)?;
    let scene = body_and_pieces(&carved.mesh, &net, render)?;
    Ok(Cell { mesh: scene, label: format!("{}{sign}", choice.label) })
}

/// One mesh of the body and its pieces. A group for each piece gives both one colour.
fn body_and_pieces(body: &Mesh, net: &Net, render: &RenderParams) -> Result<Mesh, MakeError> {
    let eye = render.eye()?;
    let up = if render.up == UpAxis::Z { DVec3::Z } else { DVec3::Y };
    let right = up.cross(eye).normalize_or(DVec3::X);
    let upright = eye.cross(right);
    let (low, high) = body.bounds().unwrap_or_default();
    let (middle, size) = (low.midpoint(high), low.distance(high));
    let mut scene = MeshBuilder::new();
    let mut groups = Vec::new();
    let mut add = |corners: Vec<DVec3>, piece: usize| {
        let ids: Vec<usize> = corners.into_iter().map(|p| scene.vertex(p)).collect();
        scene.face(ids);
        groups.push(piece);
    };
    let mut left = middle + right * (0.55 * size);
    for (i, piece) in net.pieces.iter().enumerate() {
        let all = piece.faces.iter().flat_map(|flat| &flat.polygon).copied();
        let (least, most) = bounds(all);
        let shift = left - upright * (0.5 * (least.y + most.y)) - right * least.x;
        for flat in &piece.faces {
            add(body.face_positions(FaceId::new(flat.face)), i);
            let place = |p: &DVec2| shift + right * p.x + upright * p.y;
            add(flat.polygon.iter().map(place).collect(), i);
        }
        left += right * (most.x - least.x + 0.06 * size);
    }
    let (mut mesh, _) = scene.build().map_err(MakeError::State)?;
    for (f, piece) in groups.into_iter().enumerate() {
        mesh.set_group(FaceId::new(f), &net.pieces[piece].id.to_string());
    }
    Ok(mesh)
}

fn bounds(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    let none = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
    points.fold(none, |(low, high), p| (low.min(p), high.max(p)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;
    use crate::seam::{MATCHING_LIMIT, table};
    use crate::shape::cube;

    #[test]
    fn every_choice_has_a_picture_of_its_own() {
        let cube = cube(60.0);
        let rows = table(&cube, MATCHING_LIMIT, &Silent).expect("rows");
        let choice = |row: &crate::seam::MatchingRow| FoldChoice {
            label: row.index.to_string(),
            folds: row.folds.clone(),
        };
        let choices: Vec<FoldChoice> = rows.iter().map(choice).collect();
        let all = choices_picture(&cube, &choices, &Silent).expect("a picture");
        let one = choices_picture(&cube, &choices[..1], &Silent).expect("a picture");
        let width = |png: &[u8]| u32::from_be_bytes([png[16], png[17], png[18], png[19]]);
        assert_eq!([width(&all), width(&one)], [CELL * rows.len().min(COLUMNS) as u32, CELL]);
        let other = choices_picture(&cube, &choices[1..2], &Silent).expect("a picture");
        assert_ne!(one, other);
        assert_eq!(one, choices_picture(&cube, &choices[..1], &Silent).expect("the same bytes"));
    }

    /// Body and pieces have every face once each.
    #[test]
    fn the_scene_holds_the_body_and_its_pieces() {
        let cube = cube(60.0);
        let folds = crate::seam::least_matching(&cube, &Silent).expect("folds");
        let seams = Seams::Folds(folds);
        let params = UnfoldParams::default();
        let net = unfold(&cube, &seams, &params, &MeshSource::default(), &Silent).expect("a net");
        let scene = body_and_pieces(&cube, &net, &RenderParams::default()).expect("a scene");
        assert_eq!(scene.face_count(), 12);
        assert_eq!(scene.groups().len(), net.pieces.len());
        let area = crate::measure::surface_area(&scene);
        assert!((area - 12.0 * 3600.0).abs() < 1e-6, "{area}");
    }
}
