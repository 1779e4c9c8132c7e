//! The command line of the studio.

use std::path::PathBuf;

/// Mark, slide, cut, and see the sheet beside the model, in the browser
#[derive(Debug, Clone, clap::Parser)]
#[command(
    name = "kerfold-studio",
    version,
    after_help = "It listens to this machine alone. Files are read and written in the folder in \
    which it is started, or in that of FILE.\n\nExample: kerfold-studio column.toml"
)]
pub struct Args {
    /// A recipe (.toml) or a mesh (OBJ, PLY, STL, OFF, GLB, 3MF) to begin with
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// The port to listen to; 0 takes a free one
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub port: u16,
    /// Open no browser; the address is printed all the same
    #[arg(long)]
    pub no_open: bool,
    /// Serve the page from a folder instead of the one that is built in; for work on the page
    #[arg(long, value_name = "DIR", hide = true)]
    pub page: Option<PathBuf>,
}
