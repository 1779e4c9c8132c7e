//! `kerfold verify`

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::input::read_model;
use super::output::command_line;
use super::unfold::net_text;
use super::{Console, Outcome};
use crate::code::Coded;
use crate::io::ReadOptions;
use crate::io::decode_text;
use crate::io::pieces_json::read_pieces_json;
use crate::mesh::Mesh;
use crate::net::{Net, Proof};
use crate::unfold::{LENGTH_LIMIT, ProofError, REFOLD_LIMIT, prove, renumbered};
use crate::units::{Length, counted};

/// Prove that pieces, anybody's, are those of a model: complete, true to size, without overlap,
/// folding back up
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold verify out/pieces.json out/model.obj\n\n\
    The proof that the file itself carries is not read. Exit code 1 when the pieces are not right; the first fault is reported.")]
pub(super) struct VerifyArgs {
    /// The pieces, a pieces.json
    #[arg(value_name = "PIECES")]
    pieces: PathBuf,
    /// The mesh that was unfolded: OBJ, PLY, STL, OFF, GLB or 3MF; `-` reads OBJ from standard input. Its
    /// numbers are taken as the pieces say, with their scale
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    /// The weld distance that was used for unfolding, in mm
    #[arg(long)]
    weld: Option<Length>,
}

pub(super) fn run(args: &VerifyArgs, console: &Console) -> Result<Outcome, CliError> {
    let net = read_net(&args.pieces)?;
    let weld = args.weld.map(|weld| Length::from_mm(weld.mm() / net.scale));
    let read = read_model(&args.model, &ReadOptions { weld, ..ReadOptions::default() })?;
    let mesh = scaled(read.mesh, net.scale);
    let proof = prove(&mesh, &renumbered(&mesh, &net));
    console.notes(&read.notes);
    let text = if console.json { proof_json(&net, &proof) } else { proof_text(args, &net, &proof) };
    console.result(&text)?;
    Ok(if proof.is_ok() { Outcome::Clean } else { Outcome::Findings })
}

fn read_net(path: &Path) -> Result<Net, CliError> {
    let bytes = std::fs::read(path)
        .map_err(|error| CliError::Unreadable { path: path.to_owned(), error })?;
    let text = decode_text(&bytes).map_err(|at| CliError::NotText { path: path.to_owned(), at })?;
    let (net, _) = read_pieces_json(&text)
        .map_err(|error| CliError::Pieces { path: path.to_owned(), error })?;
    if net.scale > 0.0 && net.scale.is_finite() {
        Ok(net)
    } else {
        Err(CliError::Scale { path: path.to_owned(), scale: net.scale })
    }
}

fn scaled(mut mesh: Mesh, scale: f64) -> Mesh {
    let vertices: Vec<_> = mesh.vertices().collect();
    for v in vertices {
        mesh.set_position(v, mesh.position(v) * scale, true);
    }
    mesh
}

fn limits() -> String {
    format!(
        "allowed: sides of an edge differ by {LENGTH_LIMIT:e} of its length, corners folded back \
        up by {REFOLD_LIMIT:e} of the model's size \
         (more where faces are not planar)"
    )
}

fn proof_text(args: &VerifyArgs, net: &Net, proof: &Result<Proof, ProofError>) -> String {
    let pieces = net_text(net);
    let verdict = match proof {
        Ok(proof) => format!(
            "proof: faces true to {:.1e} mm, folds up to {:.1e} mm, {}\npass: the pieces \
            are those of {}",
            proof.congruence_mm,
            proof.refold_mm,
            counted(proof.overlaps, "overlap", "overlaps"),
            args.model.display()
        ),
        Err(fault) => format!("FAIL: {fault} ({})", fault.code()),
    };
    format!("{pieces}\n{verdict}\n{}\n", limits())
}

fn proof_json(net: &Net, proof: &Result<Proof, ProofError>) -> String {
    let measured = proof.as_ref().ok().map(|proof| {
        json!({ "congruence_mm": proof.congruence_mm, "refold_mm": proof.refold_mm, "overlaps": proof.overlaps })
    });
    let findings: Vec<String> = proof.as_ref().err().map(ToString::to_string).into_iter().collect();
    let codes: Vec<String> =
        proof.as_ref().err().map(|fault| fault.code().to_string()).into_iter().collect();
    let told = json!({
        "command": command_line(), "pieces": net.pieces.len(), "proof": measured,
        "findings": findings, "codes": codes,
        "verdict": if proof.is_ok() { "pass" } else { "fail" },
        "limits": { "length_of_edge": LENGTH_LIMIT, "refold_of_size": REFOLD_LIMIT },
    });
    format!("{told:#}\n")
}
