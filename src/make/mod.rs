//! Making things: from a mesh and parameters to pieces, plates, sheets and the files of each.
//!
//! What a verb and a step of a recipe have in common stands here and nowhere else: D-forms are
//! carved, meshes are unfolded, panelled and nested, materials are looked up, files are made as
//! names and bytes. Nothing is printed or written. Verbs, recipes and the gallery call it, and so
//! can any program.

mod assembly_text;
mod candidates;
mod carve;
mod choices;
mod dform;
mod divide;
mod error;
mod fabricate;
mod flat_folds;
mod glue_file;
mod heights;
mod materials;
mod merged_net;
mod nest;
mod nest_error;
mod operate;
mod outline_source;
mod outlines;
mod outlines_error;
mod outputs;
mod panel_error;
mod panels;
mod picture;
mod planes;
mod report_pictures;
mod rim_place;
mod seam_choice;
mod show;

pub use carve::{CarvedDform, carve_dform, carve_dform_for_sheet};
pub use choices::{FoldChoice, MOST_CHOICES, choices_picture};
pub use dform::{DformError, DformParams, MatchingChoice, MatchingChoiceError};
pub use error::MakeError;
pub use fabricate::{FabricateParams, FabricateSettings, Fabrication, fabricate, lay_out_again};
pub use heights::height_mesh;
pub use materials::{MaterialError, material, with_material};
pub use nest::{NestStep, nest_files};
pub use nest_error::NestError;
pub use operate::{PiecePromise, operate};
pub use outlines::{Fit, OutlineParams, OutlinedDform, outline_list, outlined_dform};
pub use outlines_error::OutlinesError;
pub use outputs::{Output, fabrication_outputs, sheet_picture};
pub use panel_error::PanelOptionError;
pub use panels::{PaneFile, PanelFiles, PanelJob, Panelled, SolidFile, panel_model, panel_outputs};
pub use picture::{Moment, PointOut, worst_in_red};
pub(crate) use picture::{in_pieces, x_ray};
pub use planes::{PlanesStep, solid_of_planes};
pub use report_pictures::report_pictures;
pub use rim_place::RimPlace;
pub use seam_choice::SeamChoice;
pub use show::{
    AnimationFile, AnimationFileError, AssemblyForm, ShowParams, flat_mesh, flat_places,
    show_outputs,
};
