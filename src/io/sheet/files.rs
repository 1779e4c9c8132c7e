//! All files of a set of sheets, as names and bytes: in every format that was asked for, tiled, and
//! part by part.

use rayon::prelude::*;

use super::dxf::write_dxf;
use super::lbrn2::write_lbrn2;
use super::pdf::tiles::write_tiles;
use super::pdf::write_pdf;
use super::svg::write_svg;
use crate::sheet::{Drawing, PartFiles, SheetError, SheetFormat, SheetParams};

/// The bytes of one drawing in one format.
///
/// # Example
/// ```
/// use kerfold::io::sheet::files::sheet_bytes;
/// use kerfold::sheet::{SheetFormat, SheetParams};
///
/// let coupon = kerfold::sheet::kerf_coupon(3.0, "PLY 3 MM")?;
/// let svg = sheet_bytes(&coupon, SheetFormat::Svg, &SheetParams::default(), "my program");
/// assert!(String::from_utf8(svg)?.contains("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sheet_bytes(
    drawing: &Drawing,
    format: SheetFormat,
    params: &SheetParams,
    command: &str,
) -> Vec<u8> {
    match format {
        SheetFormat::Svg => write_svg(drawing, params.style(), command).into_bytes(),
        SheetFormat::Dxf => write_dxf(drawing, params.style(), command).into_bytes(),
        SheetFormat::Pdf => write_pdf(drawing, params.style(), command),
        SheetFormat::Lbrn2 => {
            write_lbrn2(drawing, |layer| params.speed(layer), command).into_bytes()
        }
    }
}

/// Names and bytes of all files: `sheet-01.svg`, `sheet-01-a4.pdf`, `P01.dxf`, ….
///
/// # Errors
/// [`SheetError::NoGlyph`] as [`write_tiles`].
///
/// # Example
/// ```
/// use kerfold::io::sheet::files::sheet_files;
/// use kerfold::prelude::*;
///
/// let net = unfold(
///     &kerfold::shape::cube(40.0),
///     &Seams::Free,
///     &UnfoldParams::default(),
///     &MeshSource { scale: 1.0, split_vertices: &[] },
///     &Silent,
/// )?;
/// let params = SheetParams::default();
/// let sheets = lay_out(&net, &params)?;
/// let files = sheet_files(&sheets.drawings, &params, "my program")?;
/// assert_eq!(files[0].0, "sheet-01.svg");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sheet_files(
    drawings: &[Drawing],
    params: &SheetParams,
    command: &str,
) -> Result<Vec<(String, Vec<u8>)>, SheetError> {
    let formats: Vec<SheetFormat> = params.files.format.iter().collect();
    let written = |drawing: &Drawing| -> Vec<(String, Vec<u8>)> {
        let name = |format: SheetFormat| format!("{}.{}", drawing.file_stem(), format.extension());
        let one =
            |&format: &SheetFormat| (name(format), sheet_bytes(drawing, format, params, command));
        formats.iter().map(one).collect()
    };
    let mut files: Vec<_> = drawings.par_iter().flat_map_iter(written).collect();
    if params.files.part_files == PartFiles::On {
        let parts = drawings.par_iter().flat_map_iter(Drawing::parts);
        files.par_extend(parts.flat_map_iter(|part| written(&part)));
    }
    if let Some(paper) = params.files.tile {
        let tiles = |drawing: &Drawing| {
            let bytes = write_tiles(drawing, paper, params.style(), command)?;
            Ok((format!("{}-{}.pdf", drawing.file_stem(), paper.name()), bytes))
        };
        let tiles: Vec<Result<_, SheetError>> = drawings.par_iter().map(tiles).collect();
        for tile in tiles {
            files.push(tile?);
        }
    }
    Ok(files)
}
