//! `kerfold kerf-test`

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::output::command_line;
use super::{Console, Outcome};
use crate::io::output::write_file;
use crate::io::sheet::files::sheet_bytes;
use crate::make::{MakeError, MaterialError, material};
use crate::sheet::{
    FileParams, Preset, SheetFormat, SheetParams, cuts_of_bar, has_comb, kerf_coupon,
};
use crate::units::Length;

/// Write a coupon that shows the kerf of a material and the slot that holds it
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold kerf-test --material ply3 -o kerf.svg\n\n\
    Cut it, push the ten blocks in their window to one side and measure the gap: it is eleven kerfs. Then find the slot of the comb \
    that holds the material tight: thickness less drawn width is the kerf, too. The numbers are hundredths of a millimetre against the \
    thickness. Paper is held by no slot; it gets twenty strips and 21 kerfs. How to read it is engraved on the coupon, too.")]
pub(super) struct KerfTestArgs {
    /// The material: a name of the bundled table or of --materials
    #[arg(long, value_name = "NAME")]
    material: Option<String>,
    /// A file with further materials (TOML)
    #[arg(long, value_name = "FILE", requires = "material")]
    materials: Option<PathBuf>,
    /// The thickness as measured; that of the material unless given; 0.01mm to 100mm
    #[arg(long, value_name = "LENGTH", required_unless_present = "material")]
    thickness: Option<Length>,
    /// Colours and stroke widths of the drawing
    #[arg(long, value_enum, default_value = "red-cut")]
    preset: Preset,
    /// The file to write: .svg, .dxf, .pdf or .lbrn2
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

pub(super) fn run(args: &KerfTestArgs, console: &Console) -> Result<Outcome, CliError> {
    let of_name = |name: &String| material(name, args.materials.as_deref());
    let made_of = args.material.as_ref().map(of_name).transpose().map_err(failure)?;
    let thickness =
        args.thickness.or(made_of.as_ref().map(|m| m.thickness)).unwrap_or_default().mm();
    let title = made_of.as_ref().map_or("KERF TEST", |m| m.title.as_str());
    let drawing = kerf_coupon(thickness, title).map_err(|e| CliError::Step(e.into()))?;
    let mut params = SheetParams {
        files: FileParams { preset: args.preset, ..FileParams::default() },
        ..SheetParams::default()
    };
    if let Some(made_of) = made_of {
        params = params.with_material(made_of);
    }
    let format = format_of(&args.output)?;
    let command = command_line();
    write_file(&args.output, &sheet_bytes(&drawing, format, &params, &command))?;
    let path = &args.output;
    if console.json {
        let (width, height) = (drawing.width, drawing.height);
        let told = json!({
            "command": command, "written": path.to_string_lossy(), "thickness": thickness,
            "width": width, "height": height,
        });
        console.result(&format!("{told:#}\n"))?;
    } else {
        let (width, height) = (drawing.width, drawing.height);
        let text = format!("{}: {width} × {height} mm, for {thickness} mm\n", path.display());
        console.result(&(text + &how_to_read(thickness)))?;
    }
    Ok(Outcome::Clean)
}

/// What to do with the coupon, and what its figures mean.
fn how_to_read(thickness: f64) -> String {
    let cuts = cuts_of_bar(thickness);
    let pieces = if has_comb(thickness) { "blocks" } else { "strips" };
    let mut text = format!(
        "1. Cut it without any kerf setting. Push the {} {pieces} in their window to one side and \
        measure the gap: gap / {cuts} = kerf. A gap of {} mm means a kerf of 0.15 mm.\n",
        cuts - 1,
        (cuts as f64 * 15.0).round() / 100.0
    );
    if has_comb(thickness) {
        text += "2. Try the material in the slots of the comb. The number of the slot that holds it \
        tight is the kerf in hundredths of a millimetre: at -15 the kerf is 0.15 mm. Both ways \
        should agree.\n";
    }
    text + "Then give --kerf, as in --kerf 0.15mm, or write it into a file for --materials.\n"
}

fn failure(error: MaterialError) -> CliError {
    CliError::Step(MakeError::from(error))
}

fn format_of(path: &Path) -> Result<SheetFormat, CliError> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    let found = SheetFormat::ALL.into_iter().find(|f| f.extension().eq_ignore_ascii_case(ending));
    found.ok_or_else(|| CliError::UnknownSheetFormat { path: path.to_owned() })
}
