//! Nets as arrays.

use kerfold::net::{FlatFace, Net, Piece, Segment};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{flat, row, shaped, whole};

/// Pieces, folds, seams, rims and proof; what is alike stands in one array.
pub(crate) fn net_dict<'py>(py: Python<'py>, net: &Net) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    let pieces = net.pieces.iter().map(|piece| piece_dict(py, piece));
    told.set_item("pieces", pieces.collect::<PyResult<Vec<_>>>()?)?;
    told.set_item("folds", folds(py, net)?)?;
    told.set_item("seams", seams(py, net)?)?;
    told.set_item("rims", rims(py, net)?)?;
    let proof = net.proof;
    told.set_item("proof", (proof.congruence_mm, proof.refold_mm, proof.overlaps))?;
    Ok(told)
}

fn piece_dict<'py>(py: Python<'py>, piece: &Piece) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    told.set_item("id", piece.id.to_string())?;
    told.set_item("outline", flat(py, &piece.outline)?)?;
    let holes = piece.holes.iter().map(|hole| flat(py, hole)).collect::<PyResult<Vec<_>>>()?;
    told.set_item("holes", holes)?;
    let faces = || piece.faces.iter();
    told.set_item("faces", row(py, faces().map(|face| whole(face.face)).collect()))?;
    let corners = faces().flat_map(|face| &face.vertices).map(|&v| whole(v));
    told.set_item("corners", row(py, corners.collect()))?;
    let mut end = 0;
    let ends = faces().map(|face: &FlatFace| {
        end += face.vertices.len();
        whole(end)
    });
    told.set_item("offsets", row(py, std::iter::once(0).chain(ends).collect()))?;
    let points: Vec<_> = faces().flat_map(|face| face.polygon.iter().copied()).collect();
    told.set_item("points", flat(py, &points)?)?;
    Ok(told)
}

fn numbers(segment: Segment) -> impl Iterator<Item = f64> {
    segment.into_iter().flat_map(|p| p.to_array())
}

fn pairs(pairs: impl Iterator<Item = [usize; 2]>) -> Vec<i64> {
    pairs.flatten().map(whole).collect()
}

fn folds<'py>(py: Python<'py>, net: &Net) -> PyResult<Bound<'py, PyDict>> {
    let (folds, n) = (&net.folds, net.folds.len());
    let told = PyDict::new(py);
    told.set_item("edges", row(py, folds.iter().map(|f| whole(f.id.0)).collect()))?;
    told.set_item("vertices", shaped(py, pairs(folds.iter().map(|f| f.edge)), &[n, 2])?)?;
    told.set_item("pieces", row(py, folds.iter().map(|f| whole(f.piece.0)).collect()))?;
    told.set_item("faces", shaped(py, pairs(folds.iter().map(|f| f.faces)), &[n, 2])?)?;
    let segments = folds.iter().flat_map(|f| numbers(f.segment)).collect();
    told.set_item("segments", shaped(py, segments, &[n, 2, 2])?)?;
    told.set_item("angles", row(py, folds.iter().map(|f| f.fold_angle).collect()))?;
    Ok(told)
}

fn seams<'py>(py: Python<'py>, net: &Net) -> PyResult<Bound<'py, PyDict>> {
    let (seams, n) = (&net.seams, net.seams.len());
    let told = PyDict::new(py);
    told.set_item("edges", row(py, seams.iter().map(|s| whole(s.id.0)).collect()))?;
    told.set_item("vertices", shaped(py, pairs(seams.iter().map(|s| s.edge)), &[n, 2])?)?;
    let pieces = pairs(seams.iter().map(|s| [s.sides[0].piece.0, s.sides[1].piece.0]));
    told.set_item("pieces", shaped(py, pieces, &[n, 2])?)?;
    let faces = pairs(seams.iter().map(|s| [s.sides[0].face, s.sides[1].face]));
    told.set_item("faces", shaped(py, faces, &[n, 2])?)?;
    let sides = seams.iter().flat_map(|s| &s.sides);
    let segments = sides.flat_map(|side| numbers(side.segment)).collect();
    told.set_item("segments", shaped(py, segments, &[n, 2, 2, 2])?)?;
    told.set_item("angles", row(py, seams.iter().map(|s| s.fold_angle).collect()))?;
    told.set_item("lengths", row(py, seams.iter().map(|s| s.length).collect()))?;
    Ok(told)
}

fn rims<'py>(py: Python<'py>, net: &Net) -> PyResult<Bound<'py, PyDict>> {
    let (rims, n) = (&net.rims, net.rims.len());
    let told = PyDict::new(py);
    told.set_item("vertices", shaped(py, pairs(rims.iter().map(|r| r.edge)), &[n, 2])?)?;
    told.set_item("pieces", row(py, rims.iter().map(|r| whole(r.piece.0)).collect()))?;
    told.set_item("faces", row(py, rims.iter().map(|r| whole(r.face)).collect()))?;
    let segments = rims.iter().flat_map(|r| numbers(r.segment)).collect();
    told.set_item("segments", shaped(py, segments, &[n, 2, 2])?)?;
    Ok(told)
}
