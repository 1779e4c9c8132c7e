//! Gluing files: outlines by letters or names, and the seams between them.
//!
//! ```toml
//! seams = ["A[0..1/2] = B[1/2..1]", "A[1/2..1] = B[0mm..120mm]"]
//!
//! [outlines]
//! A = "lens-0.5@200mm"
//! B = "other.svg"
//! ```

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::MakeError;
use super::outline_source::read_outline;
use super::outlines_error::OutlinesError;
use super::rim_place::RimPlace;
use crate::gluing::{Gluing, Outline, Seam, Span};
use crate::io::read_text;
use crate::units::nearest_word;

/// More pieces than that are refused.
const MOST_PIECES: usize = 500;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GlueFile {
    outlines: BTreeMap<String, String>,
    seams: Vec<String>,
}

/// Reads a gluing file. Drawings are looked for in its folder.
///
/// # Errors
/// [`MakeError::Outlines`] with what is wrong and where, and what reading the outlines can refuse.
pub(super) fn read_glue_file(path: &Path, points: usize, slack: f64) -> Result<Gluing, MakeError> {
    let fault = |fault: String| OutlinesError::Glue { path: path.to_owned(), fault };
    let text = read_text(path)
        .map_err(|source| OutlinesError::Unreadable { path: path.to_owned(), source })?;
    let file: GlueFile = toml::from_str(&text).map_err(|error| fault(error.to_string()))?;
    if file.outlines.is_empty() {
        return Err(fault("it names no outline under [outlines]".to_owned()).into());
    }
    if file.outlines.len() > MOST_PIECES {
        return Err(fault(format!("more than {MOST_PIECES} outlines")).into());
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let names: Vec<&str> = file.outlines.keys().map(String::as_str).collect();
    let outlines: Vec<Outline> = file
        .outlines
        .iter()
        .map(|(name, source)| Ok(read_outline(source, folder)?.renamed(name)))
        .collect::<Result<_, MakeError>>()?;
    let seams = file
        .seams
        .iter()
        .map(|text| {
            seam(text, &names, &outlines).map_err(|why| fault(format!("seam `{text}`: {why}")))
        })
        .collect::<Result<_, _>>()?;
    Ok(Gluing { outlines, seams, points, slack })
}

fn seam(text: &str, names: &[&str], outlines: &[Outline]) -> Result<Seam, String> {
    let (a, b) =
        text.split_once('=').ok_or("it has no `=`; write it like A[0..1/2] = B[1/2..1]")?;
    Ok(Seam { a: span(a.trim(), names, outlines)?, b: span(b.trim(), names, outlines)? })
}

/// `A`, the whole rim, or `A[from..to]`.
fn span(text: &str, names: &[&str], outlines: &[Outline]) -> Result<Span, String> {
    let (name, range) = match text.split_once('[') {
        None => (text, "0..1"),
        Some((name, rest)) => {
            let range = rest.strip_suffix(']').ok_or(format!("`{text}` lacks its `]`"))?;
            (name.trim(), range)
        }
    };
    let piece = names.iter().position(|n| *n == name).ok_or_else(|| {
        let near = nearest_word(name, names.iter().copied());
        let advice = near.map_or_else(
            || format!("known are {}", names.join(", ")),
            |near| format!("did you mean {near}?"),
        );
        format!("there is no outline `{name}`; {advice}")
    })?;
    let (from, to) = range
        .split_once("..")
        .ok_or(format!("`{range}` has no `..`; write it like 0..1/2 or 10mm..60mm"))?;
    let whole = outlines[piece].length();
    let place = |text: &str| {
        text.trim().parse::<RimPlace>().map(|p| p.mm(whole)).map_err(|error| error.to_string())
    };
    let (from, mut to) = (place(from)?, place(to)?);
    if to <= from {
        to += whole;
    }
    if to <= from || to - from > whole * (1.0 + 1e-9) {
        return Err(format!("`{text}` runs around the rim more than once, or against it"));
    }
    Ok(Span { piece, from, to })
}
