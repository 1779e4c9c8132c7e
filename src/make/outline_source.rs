//! Outlines by name or from drawings.

use std::path::Path;

use glam::DVec2;

use super::MakeError;
use super::outlines_error::OutlinesError;
use crate::gluing::{Outline, named_outline};
use crate::io::artwork::read_artwork_within;
use crate::io::order_artwork::GAP;
use crate::io::read_text;
use crate::lint::ArtPath;
use crate::units::Length;

/// How far flattened curves may be from the true ones, in mm: chords of a seam must not see the
/// steps.
const FLATNESS: f64 = 2e-6;

/// Reads an outline: a name, or the path of a drawing, with a size after `@` or without.
///
/// # Errors
/// [`MakeError::Gluing`] for a name that is none, [`MakeError::Outlines`] for a drawing that holds
/// no outline.
pub(super) fn read_outline(source: &str, folder: &Path) -> Result<Outline, MakeError> {
    let (name, extent) = match source.rsplit_once('@') {
        Some((name, size)) if !folder.join(source).is_file() => (
            name,
            Some(size.parse::<Length>().map_err(|error| OutlinesError::Options {
                what: error.to_string(),
                advice: "write a size like circle@180mm",
            })?),
        ),
        _ => (source, None),
    };
    let path = folder.join(name);
    let is_path = name.contains(['.', '/', '\\']) && named_outline(name).is_err();
    let is_list = ["csv", "txt"].map(Some).contains(&path.extension().and_then(|e| e.to_str()));
    let outline = match path.is_file() || is_path {
        true if is_list => listed(&path, name)?,
        true => drawn(&path, name)?,
        false => named_outline(name)?,
    };
    match extent.map(Length::mm) {
        None => Ok(outline),
        Some(mm) if mm > 0.0 => Ok(outline.scaled(mm / outline.size().max_element())),
        Some(mm) => Err(OutlinesError::Options {
            what: format!("the size {mm} mm of {name} is not above 0"),
            advice: "write a size like circle@180mm",
        }
        .into()),
    }
}

/// A list of points: x,y in mm on each line; lines that begin with # are left out.
fn listed(path: &Path, name: &str) -> Result<Outline, MakeError> {
    let text = read_text(path)
        .map_err(|source| OutlinesError::Unreadable { path: path.to_owned(), source })?;
    let mut points = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let numbers: Vec<f64> = line
            .split(|c: char| c == ',' || c == ';' || c.is_whitespace())
            .filter(|word| !word.is_empty())
            .map_while(|word| word.parse().ok())
            .collect();
        let [x, y] = numbers.as_slice() else {
            return Err(OutlinesError::Points { path: path.to_owned(), line: i + 1 }.into());
        };
        points.push(DVec2::new(*x, *y));
    }
    Ok(Outline::new(&stem(name), &points)?)
}

/// The name of a file without folders and ending.
fn stem(name: &str) -> String {
    Path::new(name)
        .file_stem()
        .map_or_else(|| name.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

fn drawn(path: &Path, name: &str) -> Result<Outline, MakeError> {
    let bytes = std::fs::read(path)
        .map_err(|source| OutlinesError::Unreadable { path: path.to_owned(), source })?;
    let (_, pages) = read_artwork_within(path, &bytes, FLATNESS)
        .map_err(|error| OutlinesError::Drawing { path: path.to_owned(), error })?;
    let paths: Vec<&ArtPath> = pages.iter().flat_map(|page| &page.paths).collect();
    let closed: Vec<&&ArtPath> = paths.iter().filter(|p| is_closed(p)).collect();
    let [outline] = closed.as_slice() else {
        return Err(OutlinesError::NotOne {
            path: path.to_owned(),
            closed: closed.len(),
            open: paths.len() - closed.len(),
        }
        .into());
    };
    Ok(Outline::new(&stem(name), &outline.points)?)
}

/// Whether a line bounds an area: the file says so, or it ends where it begins.
pub(super) fn is_closed(path: &ArtPath) -> bool {
    let ends_meet = match (path.points.first(), path.points.last()) {
        (Some(a), Some(b)) => path.points.len() > 3 && a.distance(*b) <= GAP,
        _ => false,
    };
    path.points.len() > 2 && (path.closed || ends_meet)
}
