//! `kerfold-studio`: starts the server and opens the page.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use clap::Parser;
use kerfold::code::Coded;
use kerfold_studio::{Args, StudioError, StudioOptions, serve};

fn main() -> ExitCode {
    let args = Args::parse();
    let runtime =
        tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build();
    let result = match runtime {
        Ok(runtime) => {
            let result = runtime.block_on(run(&args));
            // Work that is still going on may not hold the program up.
            runtime.shutdown_background();
            result
        }
        Err(error) => Err(StudioError::Port { port: args.port, error }),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "kerfold-studio: {error} ({})", error.code());
            ExitCode::from(2)
        }
    }
}

async fn run(args: &Args) -> Result<(), StudioError> {
    let serving = serve(options(args).map_err(|error| *error)?, args.port).await?;
    let address = serving.address();
    let mut out = std::io::stdout();
    let _ = writeln!(out, "the studio is open at {address}\nCtrl-C closes it").and(out.flush());
    if !args.no_open && !open(&address) {
        let _ =
            writeln!(std::io::stderr(), "no browser could be opened; open the address yourself");
    }
    let stop = tokio::signal::ctrl_c();
    tokio::select! {
        ended = serving.run() => ended.map_err(|error| StudioError::Port { port: args.port, error }),
        _ = stop => Ok(()),
    }
}

fn options(args: &Args) -> Result<StudioOptions, Box<StudioError>> {
    let page = args.page.clone();
    let Some(path) = &args.file else {
        return Ok(StudioOptions { folder: PathBuf::from("."), file: None, page });
    };
    let missing = |message: &str| {
        let (file, message) = (path.display().to_string(), message.to_owned());
        Box::new(StudioError::File { file, message })
    };
    if !path.is_file() {
        return Err(missing("there is no such file; check the name and the folder"));
    }
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| missing("the name must be text in UTF-8"))?;
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    Ok(StudioOptions { folder, file: Some(name.to_owned()), page })
}

/// Opens the address in the user's browser; `false` when nothing does.
fn open(address: &str) -> bool {
    let programs: &[&[&str]] = if cfg!(target_os = "macos") {
        &[&["open"]]
    } else if cfg!(windows) {
        &[&["cmd", "/c", "start", ""]]
    } else {
        &[&["xdg-open"], &["sensible-browser"]]
    };
    programs.iter().any(|program| {
        let silent = std::process::Stdio::null;
        let mut command = Command::new(program[0]);
        command.args(&program[1..]).arg(address).stdin(silent()).stdout(silent()).stderr(silent());
        command.spawn().is_ok()
    })
}
