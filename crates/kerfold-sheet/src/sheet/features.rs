//! What lies on a piece besides its outline.

use std::collections::BTreeMap;

use super::error::SheetError;
use super::stretch::Stretch;
use crate::net::{Fold, Net, PieceId, Seam};

/// Folds, seams and stretches of one piece.
#[derive(Default)]
pub(crate) struct Features<'a> {
    /// The folds inside of it.
    pub folds: Vec<&'a Fold>,
    /// The seams of the piece with the side, 0 or 1, that lies on it.
    pub seams: Vec<(&'a Seam, usize)>,
    /// Stretches of seam with the side, 0 for forwards and 1 for its partner, that lies on the
    /// piece.
    pub stretches: Vec<(&'a Stretch, usize)>,
}

/// The features of all pieces of a net.
///
/// # Errors
/// [`SheetError::UnknownPiece`] for a fold or seam on a piece that the net lacks.
pub(crate) fn features<'a>(
    net: &'a Net,
    stretches: &'a [Stretch],
) -> Result<BTreeMap<PieceId, Features<'a>>, SheetError> {
    let mut all: BTreeMap<PieceId, Features<'a>> =
        net.pieces.iter().map(|p| (p.id, Features::default())).collect();
    let unknown = |edge: String, piece| SheetError::UnknownPiece { edge, piece };
    for fold in &net.folds {
        let here =
            all.get_mut(&fold.piece).ok_or_else(|| unknown(fold.id.to_string(), fold.piece))?;
        here.folds.push(fold);
    }
    for seam in &net.seams {
        for (i, side) in seam.sides.iter().enumerate() {
            let here =
                all.get_mut(&side.piece).ok_or_else(|| unknown(seam.id.to_string(), side.piece))?;
            here.seams.push((seam, i));
        }
    }
    for stretch in stretches {
        for (i, piece) in stretch.pieces.iter().enumerate() {
            all.entry(*piece).or_default().stretches.push((stretch, i));
        }
    }
    Ok(all)
}
