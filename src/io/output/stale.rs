//! Files of an earlier run that are no part of the result any more.
//!
//! Only what kerfold wrote is named: a file has one of the names that it gives to files in folders,
//! and its own command line inside. Pictures carry none, so the picture of a sheet goes with the
//! sheet.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

/// Endings of the drawings of sheets and parts.
const DRAWINGS: [&str; 4] = ["svg", "dxf", "pdf", "lbrn2"];
/// Names that are the same in every run.
const FIXED: [&str; 20] = [
    "pieces.json",
    "layout.json",
    "assembly.txt",
    "sheets.html",
    "panes.pdf",
    "panels.json",
    "panels.csv",
    "edges.csv",
    "nodes.csv",
    "cutting-list.csv",
    "assembly-map.svg",
    "assembly-map.pdf",
    "plates.step",
    "plates.obj",
    "plates.mtl",
    "plates.glb",
    "plates.stl",
    "model.obj",
    "report.json",
    "report.html",
];
/// How every command line in a file begins.
const COMMAND: &[u8] = b"kerfold ";
/// It stands near the start, or in a PDF near the end.
const SEARCHED: usize = 16 * 1024;

/// The files of earlier runs in `folder` but those of the names `now`, sorted.
pub(super) fn of_earlier_runs(folder: &Path, now: &[&str]) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
    let others: Vec<String> = names.filter(|name| !now.contains(&name.as_str())).collect();
    let mut stale: Vec<String> = Vec::new();
    for name in others.iter().filter(|name| is_ours_by_name(name)) {
        if has_command(&folder.join(name)) {
            stale.push(name.clone());
        }
    }
    let is_picture_of_stale = |name: &&String| {
        let stem = name.strip_suffix(".png");
        stem.is_some_and(|stem| is_sheet(stem) && stale.iter().any(|s| stem_of(s) == stem))
    };
    let pictures: Vec<String> = others.iter().filter(is_picture_of_stale).cloned().collect();
    stale.extend(pictures);
    stale.sort_unstable();
    stale.into_iter().map(|name| folder.join(name)).collect()
}

fn stem_of(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

fn is_ours_by_name(name: &str) -> bool {
    let is_drawing = |ending: &str| DRAWINGS.contains(&ending);
    FIXED.contains(&name)
        || name
            .rsplit_once('.')
            .is_some_and(|(stem, ending)| is_drawing(ending) && (is_sheet(stem) || is_part(stem)))
}

/// `sheet-01`, or `sheet-01-a4` for its tiles.
fn is_sheet(stem: &str) -> bool {
    let Some(rest) = stem.strip_prefix("sheet-") else { return false };
    let (number, paper) = rest.split_once('-').unwrap_or((rest, "a4"));
    is_number(number) && !paper.is_empty() && paper.bytes().all(|b| b.is_ascii_alphanumeric())
}

/// `P01`, or `pane-P01` for its drawing.
fn is_part(stem: &str) -> bool {
    let stem = stem.strip_prefix("pane-").unwrap_or(stem);
    stem.strip_prefix('P').is_some_and(is_number)
}

fn is_number(text: &str) -> bool {
    text.len() >= 2 && text.bytes().all(|b| b.is_ascii_digit())
}

/// Whether a plain file carries a command line of ours.
fn has_command(path: &Path) -> bool {
    let is_plain = path.symlink_metadata().is_ok_and(|there| there.is_file());
    is_plain && ends_of(path).is_ok_and(|text| text.windows(COMMAND.len()).any(|w| w == COMMAND))
}

/// The start and the end of a file.
fn ends_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut text = Vec::new();
    file.by_ref().take(SEARCHED as u64).read_to_end(&mut text)?;
    let end = length.saturating_sub(SEARCHED as u64).max(text.len() as u64);
    file.seek(SeekFrom::Start(end))?;
    file.take(SEARCHED as u64).read_to_end(&mut text)?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_others_are_not_ours() {
        for ours in [
            "sheet-01.svg",
            "sheet-12-a4.pdf",
            "P07.dxf",
            "pane-P07.dxf",
            "pieces.json",
            "sheet-100.lbrn2",
        ] {
            assert!(is_ours_by_name(ours), "{ours}");
        }
        for other in [
            "sheet.svg",
            "sheet-1a.svg",
            "sheet-01.txt",
            "sheet-01-.pdf",
            "P.svg",
            "Page.pdf",
            "x.json",
        ] {
            assert!(!is_ours_by_name(other), "{other}");
        }
    }
}
