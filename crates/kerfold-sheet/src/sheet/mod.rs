//! Pieces to sheets: kerf, joints, labels, placing, cutting order; knows pieces, never meshes.
//!
//! Frames: a piece has its own (y up, seen from outside); a sheet has its origin at the bottom left
//! and y up. A point p of a piece lands at R(rotation)·p + (x, y). Nothing is mirrored. All numbers
//! are millimetres, rotations are degrees.
//!
//! The way of a piece: it gets its joints ([`Joint`]), its outline grows by half the kerf
//! ([`CutShape`]), is turned to its smallest bounding box ([`smallest_box`]), placed ([`Layout`]),
//! lettered, drawn ([`Drawing`]), and measured once more ([`verify`]) before anybody may write a
//! file.

mod assembly;
mod boundary;
mod bounding_box;
mod common_line;
mod contact;
mod distance;
mod draw;
mod drawing;
mod error;
mod features;
mod files;
mod info;
mod joint;
mod joint_kind;
mod kerf;
mod kerf_coupon;
mod lay_out;
mod layout;
mod letter;
mod material;
mod nest;
mod order;
mod params;
mod part;
mod place;
mod score;
mod score_gap;
mod slit;
mod stock;
mod stretch;
mod verify;

pub use assembly::{Assembly, AssemblyStep, assembly_of};
pub use bounding_box::{OrientedBox, smallest_box};
pub use drawing::{Drawing, Layer, LayerKind, Mark, MarkKind, PlateSide, Stroke};
pub use error::{SheetError, TooLarge};
pub use files::{
    Colours, FileParams, Formats, FormatsError, Paper, PartFiles, Pen, Preset, Reference, Rgb,
    SheetFormat, Style,
};
pub use joint::{FlapSide, JointFallback, JointParams, JointReport, Substitute};
pub use joint_kind::Joint;
pub use kerf::CutShape;
pub use kerf_coupon::{cuts_of_bar, has_comb, kerf_coupon};
pub use lay_out::{SheetSet, fits, lay_out, lay_out_watched};
pub use layout::{Fans, Layout, NearScores, Placed, Sheet, SheetFinding, SheetId, SheetReport};
pub use letter::{
    Angles, CAPITAL, Labels, LetterParams, Lettering, glyph, lettering, plain_lettering,
};
pub use material::{Hex, Material, MaterialColours, Speeds};
pub use nest::{
    CommonLine, Corners, DefectList, GroupList, Guillotine, NestParams, Rotation, RotationList,
    StockList,
};
pub use params::{PieceKind, SheetParams};
pub use score::{FoldWay, ScoreParams, ScoreStyle};
pub use stock::{SheetSize, StockParams};
pub use stretch::Stretch;
pub use verify::{clearance, verify};

#[cfg(test)]
mod testing;
