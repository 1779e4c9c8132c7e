//! Options of panels that do not fit together.

use crate::code::codes;

/// Why panels cannot be made as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PanelOptionError {
    /// No thickness.
    #[error("panels need a thickness; give it, for example thickness 10mm, or a material")]
    NoThickness,
    /// A joint of the sheets instead of one of the panels.
    #[error(
        "panels do not take joint; say what their edges are with edges, for example edges finger"
    )]
    Joint,
    /// An option that nothing uses.
    #[error("{option} is used by no edge; leave it out, or let edges be {by}")]
    Unused {
        /// The option.
        option: &'static str,
        /// What would use it.
        by: &'static str,
    },
}

codes!(error PanelOptionError {
    NoThickness = 741,
    Joint = 742,
    Unused = 743,
});
