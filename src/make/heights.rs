//! Height fields over the area of a drawing.

use std::path::Path;

use glam::DVec2;

use super::MakeError;
use super::outline_source::is_closed;
use super::outlines_error::OutlinesError;
use crate::gluing::named_outline;
use crate::io::artwork::read_artwork;
use crate::io::order_artwork::GAP;
use crate::io::read_text;
use crate::lint::ArtPath;
use crate::mesh::Mesh;
use crate::op::OpError;
use crate::panelize::{Domain, HeightParams, height_field};

/// The mesh of a height field; where its domain is a drawing, that is read, relative to `folder`.
/// Open lines of a drawing are left out, which a note says.
///
/// # Errors
/// [`MakeError::Outlines`] for a drawing that cannot be read, [`MakeError::Gluing`] for the name of
/// an outline that is none, [`MakeError::Op`] for a domain or a
/// formula that cannot be used.
pub fn height_mesh(params: &HeightParams, folder: &Path) -> Result<(Mesh, Vec<String>), MakeError> {
    let mut params = params.clone();
    let mut notes = Vec::new();
    if let Domain::Drawing { path, unit_mm, .. } = &params.domain {
        let name = path.to_string_lossy();
        let is_name = !Domain::is_file(path);
        let path = folder.join(path);
        let ending = path.extension().unwrap_or_default();
        let is_list = ["csv", "txt"].iter().any(|list| ending.eq_ignore_ascii_case(list));
        let contours = if is_name {
            vec![named_outline(&name)?.points().to_vec()]
        } else if is_list {
            listed(&path, *unit_mm)?
        } else {
            let (contours, open) = drawn(&path)?;
            if open > 0 {
                notes.push(format!("{open} open lines of {} were left out", path.display()));
            }
            contours
        };
        params.domain = params.domain.of_contours(contours);
    }
    Ok((height_field(&params).map_err(OpError::from)?, notes))
}

/// Lists of points, x,y on each line, an empty line between two outlines; a first point may be
/// repeated at the end.
fn listed(path: &Path, unit_mm: f64) -> Result<Vec<Vec<DVec2>>, OutlinesError> {
    let text = read_text(path)
        .map_err(|source| OutlinesError::Unreadable { path: path.to_owned(), source })?;
    let mut contours = vec![Vec::new()];
    for (i, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default().trim();
        if content.is_empty() {
            // A line with a comment alone divides nothing.
            if line.trim().is_empty() {
                contours.push(Vec::new());
            }
            continue;
        }
        let words = content.split(|c: char| c == ',' || c == ';' || c.is_whitespace());
        let numbers: Option<Vec<f64>> =
            words.filter(|word| !word.is_empty()).map(|word| word.parse().ok()).collect();
        match numbers.as_deref() {
            Some([x, y]) if x.is_finite() && y.is_finite() => {
                if let Some(contour) = contours.last_mut() {
                    contour.push(DVec2::new(*x, *y) * unit_mm);
                }
            }
            _ => return Err(OutlinesError::Points { path: path.to_owned(), line: i + 1 }),
        }
    }
    contours.retain(|contour| !contour.is_empty());
    contours.iter_mut().for_each(closed_up);
    Ok(contours)
}

/// The closed lines of a drawing, and how many others it has.
fn drawn(path: &Path) -> Result<(Vec<Vec<DVec2>>, usize), OutlinesError> {
    let bytes = std::fs::read(path)
        .map_err(|source| OutlinesError::Unreadable { path: path.to_owned(), source })?;
    let (_, pages) = read_artwork(path, &bytes)
        .map_err(|error| OutlinesError::Drawing { path: path.to_owned(), error })?;
    let lines: Vec<&ArtPath> = pages.iter().flat_map(|page| &page.paths).collect();
    let closed = lines.iter().filter(|line| is_closed(line));
    let mut contours: Vec<Vec<DVec2>> = closed.map(|line| line.points.clone()).collect();
    contours.iter_mut().for_each(closed_up);
    let open = lines.len() - contours.len();
    Ok((contours, open))
}

/// Without a last point that is the first.
fn closed_up(contour: &mut Vec<DVec2>) {
    let first = contour.first().copied();
    while contour.len() > 1 && first.zip(contour.last()).is_some_and(|(a, b)| a.distance(*b) <= GAP)
    {
        contour.pop();
    }
}
