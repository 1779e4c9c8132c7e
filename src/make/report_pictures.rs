//! The pictures of a report page: the model against its limits, and the worst panels.

use crate::check::Report;
use crate::io::report::page::{PanelPictures, ReportPicture, ReportPictures};
use crate::mesh::{FaceId, FaceMap, Mesh};
use crate::picture::{
    Colour, Picture, PictureError, Projection, RenderParams, View, render_marked, render_model,
    render_shares,
};

/// Panels that get a picture.
const PANELS: usize = 12;
/// Width of the pictures of panels, in pixels; twice what a page shows, for printing.
const THUMB: u32 = 320;

/// Draws the model by share of the limit, by deviation in mm and by valence, and each of the worst
/// panels. `render` says from where the model is seen and which axis is up.
///
/// # Errors
/// [`PictureError`] for a model that cannot be drawn.
pub fn report_pictures(
    mesh: &Mesh,
    report: &Report,
    render: &RenderParams,
) -> Result<ReportPictures, PictureError> {
    let mut shares = FaceMap::filled(mesh.face_slots(), 0.0);
    for f in &report.faces {
        shares[f.face] = report.limits.share(&f.planarity);
    }
    let sized = |width, height, colour| RenderParams {
        width,
        height: Some(height),
        colour,
        ..render.clone()
    };
    let view = |picture: Picture, caption: &str| ReportPicture {
        caption: caption.to_owned(),
        png: picture.to_png(),
    };
    let views = vec![
        view(
            render_shares(mesh, &sized(1400, 640, Colour::Planarity), &shares)?,
            "Each panel by how much of its limit it uses, in per cent: blue is planar, from orange \
            on the limit is broken; \
             200 % and more look alike.",
        ),
        view(
            render_model(mesh, &sized(800, 600, Colour::Planarity))?,
            "Each panel by the largest distance of a corner from its plane, in mm.",
        ),
        view(
            render_model(mesh, &sized(800, 600, Colour::Valence))?,
            "Each node by its valence, with the number of nodes; three is exact for plates.",
        ),
    ];
    // Without a deviation there is no worst panel.
    let worst = report.worst_faces(PANELS).into_iter().filter(|f| f.planarity.mm > 0.0);
    let panels = worst.map(|f| panel(mesh, f.face, render)).collect::<Result<_, _>>()?;
    Ok(ReportPictures { views, panels })
}

/// A panel seen along its normal: on the model, and with its neighbours only.
fn panel(mesh: &Mesh, face: FaceId, render: &RenderParams) -> Result<PanelPictures, PictureError> {
    let view = mesh.plane(face).map_or(render.view, |plane| View::From(plane.normal()));
    let params = RenderParams {
        width: THUMB,
        height: Some(THUMB * 3 / 4),
        view,
        projection: Projection::Parallel,
        ..render.clone()
    };
    let place = render_marked(mesh, &params, face)?.to_png();
    let close = match neighbourhood(mesh, face) {
        Some((patch, marked)) => render_marked(&patch, &params, marked)?.to_png(),
        None => place.clone(),
    };
    Ok(PanelPictures { face, place, close })
}

/// A mesh of a face and of those that share a corner with it, and the face's number there. Only the
/// face where its neighbours are no surface without the rest; `None` for a face that is none by
/// itself.
fn neighbourhood(mesh: &Mesh, face: FaceId) -> Option<(Mesh, FaceId)> {
    let mut faces: Vec<FaceId> =
        mesh.face_vertices(face).flat_map(|v| mesh.vertex_faces(v)).collect();
    faces.sort_unstable();
    faces.dedup();
    [faces, vec![face]].into_iter().find_map(|faces| {
        let patch = part(mesh, &faces)?;
        Some((patch, FaceId::new(faces.iter().position(|&f| f == face)?)))
    })
}

/// Some faces of a mesh, in this order.
fn part(mesh: &Mesh, faces: &[FaceId]) -> Option<Mesh> {
    let mut corners: Vec<_> = faces.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
    corners.sort_unstable();
    corners.dedup();
    let polygons = faces.iter().map(|&f| {
        mesh.face_vertices(f).filter_map(|v| corners.binary_search(&v).ok()).collect::<Vec<_>>()
    });
    Mesh::from_faces(corners.iter().map(|&v| mesh.position(v)), polygons).ok()
}
