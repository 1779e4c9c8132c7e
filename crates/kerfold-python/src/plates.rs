//! Plates as arrays.

use glam::DVec3;
use kerfold::make::Panelled;
use kerfold::panel::{PanelRow, Plate, solid};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{flat, row, shaped, spatial, whole};
use crate::trouble::coded;

/// All plates, in the order of the faces.
pub(crate) fn plate_dicts<'py>(
    py: Python<'py>,
    panelled: &Panelled,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let rows = &panelled.schedule.panels;
    panelled.plates.plates.iter().zip(rows).map(|(plate, row)| plate_dict(py, plate, row)).collect()
}

fn plate_dict<'py>(
    py: Python<'py>,
    plate: &Plate,
    panel: &PanelRow,
) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    told.set_item("id", panel.id.to_string())?;
    told.set_item("face", panel.face)?;
    told.set_item("layer", panel.layer.as_deref())?;
    told.set_item("group", panel.group)?;
    told.set_item("is_mirrored", panel.is_mirrored)?;
    told.set_item("thickness", panel.thickness)?;
    told.set_item("area", panel.area)?;
    told.set_item("volume", panel.volume)?;
    told.set_item("mass", panel.mass)?;
    told.set_item("edges", row(py, panel.edges.iter().map(|e| whole(e.index())).collect()))?;
    told.set_item("bevels", row(py, panel.bevels.clone()))?;
    let frame = &plate.frame;
    let axes = [frame.origin, frame.x, frame.y, frame.normal];
    told.set_item("frame", spatial(py, &axes)?)?;
    told.set_item("front", flat(py, &plate.front)?)?;
    told.set_item("back", flat(py, &plate.back)?)?;
    told.set_item("blank", flat(py, &plate.blank)?)?;
    let holes = plate.holes.iter().flat_map(|h| [h.centre.x, h.centre.y, h.radius]).collect();
    told.set_item("holes", shaped(py, holes, &[plate.holes.len(), 3])?)?;
    let body = solid(plate).map_err(|error| coded(&error))?;
    let points: &[DVec3] = &body.points;
    told.set_item("vertices", spatial(py, points)?)?;
    let triangles: Vec<i64> = body
        .faces
        .iter()
        .flat_map(|face| &face.triangles)
        .flatten()
        .map(|&v| i64::from(v))
        .collect();
    let count = triangles.len() / 3;
    told.set_item("triangles", shaped(py, triangles, &[count, 3])?)?;
    Ok(told)
}
