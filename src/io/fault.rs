//! What can be wrong with the content of a mesh file.

use crate::code::codes;

/// How the content of a mesh file breaks its format. Texts from the file are shortened.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContentFault {
    /// Bytes that no text has.
    #[error(
        "this is binary data, not {format} text; check the file's type or export the model again"
    )]
    NotText {
        /// The format that was expected.
        format: &'static str,
    },
    /// A line that should be a vertex.
    #[error("`{text}` is not a vertex; it needs three numbers, as in `{example}`")]
    NotAVertex {
        /// The line.
        text: String,
        /// How it should look.
        example: &'static str,
    },
    /// A line that should be a face.
    #[error("`{text}` is not a face; it needs the numbers of its vertices, as in `{example}`")]
    NotAFace {
        /// The line.
        text: String,
        /// How it should look.
        example: &'static str,
    },
    /// An OBJ face or seam names a vertex that is not there.
    #[error(
        "`{text}` names vertex {index}, but the file has {count}, counted from 1; correct the \
        number or export the model again"
    )]
    NoSuchVertex {
        /// The line.
        text: String,
        /// The number as it stands in the file.
        index: i64,
        /// Number of vertices.
        count: usize,
    },
    /// An OBJ seam line that cannot be read.
    #[error(
        "`{text}` is not a seam; it needs the numbers of at least two vertices, as in `l 1 2 3`"
    )]
    NotASeam {
        /// The line.
        text: String,
    },
    /// A line of an edge list that cannot be read.
    #[error(
        "`{text}` is not an edge; it needs the numbers of its two vertices, counted from 0, as in \
        `3 17`"
    )]
    NotAnEdge {
        /// The line.
        text: String,
    },
    /// A header line of a PLY or OFF file that cannot be read.
    #[error("`{text}` does not belong in the header of a {format} file; {wanted}")]
    BadHeader {
        /// The line.
        text: String,
        /// PLY or OFF.
        format: &'static str,
        /// What should be there.
        wanted: &'static str,
    },
    /// The header says that there are more elements than the rest of the file can hold.
    #[error(
        "the header announces {count} of `{element}`, but only {bytes} bytes follow; \
         the file is cut short or its header is wrong, export the model again"
    )]
    CountTooLarge {
        /// The element.
        element: String,
        /// What the header says.
        count: u64,
        /// How much is left of the file.
        bytes: usize,
    },
    /// A PLY file without a property that a mesh needs.
    #[error(
        "`{element}` has no property `{property}`; export the model again with its vertices and \
        faces"
    )]
    NoProperty {
        /// The element.
        element: &'static str,
        /// The missing property.
        property: &'static str,
    },
    /// The file ends within its elements.
    #[error(
        "the file ends within `{element}` number {index} (of {count}, counted from 0); it is cut \
        short, export the model again"
    )]
    CutShort {
        /// The element.
        element: String,
        /// Which one.
        index: usize,
        /// How many there should be.
        count: usize,
    },
    /// A value of a PLY file that does not fit its property.
    #[error(
        "`{text}` in `{element}` number {index} (counted from 0) is not {wanted}; correct it or \
        export the model again"
    )]
    BadValue {
        /// What stands there.
        text: String,
        /// The element.
        element: String,
        /// Which one.
        index: usize,
        /// What should be there.
        wanted: &'static str,
    },
    /// A text STL file with a word out of order.
    #[error(
        "`{text}` is out of place in triangle {triangle} (counted from 0); {wanted}, or export the \
        model again"
    )]
    BadTriangle {
        /// What stands there.
        text: String,
        /// The triangle.
        triangle: usize,
        /// What should be there.
        wanted: &'static str,
    },
    /// An STL triangle with a NaN or an infinite coordinate.
    #[error(
        "triangle {triangle} (counted from 0) has a coordinate that is not a finite number; \
        correct it or export the model again"
    )]
    TriangleNotFinite {
        /// The triangle.
        triangle: usize,
    },
    /// A file whose first line is not that of its format.
    #[error("this is not {format}: it begins with `{text}`; check the file's type")]
    NotThisFormat {
        /// The format that was expected.
        format: &'static str,
        /// How the file begins.
        text: String,
    },
    /// A file of several parts of which one is damaged, missing, or says what cannot be.
    #[error("this {format} cannot be read: {what}; export the model again")]
    BrokenParts {
        /// GLB or 3MF.
        format: &'static str,
        /// What is wrong.
        what: String,
    },
    /// A file that can only be read with an extension of its format.
    #[error(
        "this {format} needs the extension `{name}`, which is not read; export the model again \
        without it"
    )]
    NeedsExtension {
        /// GLB or 3MF.
        format: &'static str,
        /// The extension.
        name: String,
    },
    /// A file of which the parts, placed as it says, are more than anybody could want.
    #[error(
        "the file places its meshes so often that they have more than {most} corners; export fewer \
        copies, or simplify the model first"
    )]
    TooMuchMesh {
        /// How many corners are read.
        most: usize,
    },
    /// A packed file that is too large when it is unpacked.
    #[error(
        "the file unpacks to more than {most} MiB; simplify the model first, or export it as binary \
        STL or PLY"
    )]
    TooMuchUnpacked {
        /// How many MiB are unpacked.
        most: usize,
    },
    /// Heights that cannot be read, or that make no whole grid.
    #[error(
        "{what}; heights are a table whose first row is x and first column y, or rows x, y, z of \
        the places of a whole grid"
    )]
    BrokenGrid {
        /// What is wrong.
        what: String,
    },
}

codes!(error ContentFault {
    NotText = 131,
    NotAVertex = 132,
    NotAFace = 133,
    NoSuchVertex = 134,
    NotASeam = 135,
    NotAnEdge = 136,
    BadHeader = 137,
    CountTooLarge = 138,
    NoProperty = 139,
    CutShort = 140,
    BadValue = 141,
    BadTriangle = 142,
    TriangleNotFinite = 143,
    NotThisFormat = 144,
    BrokenGrid = 145,
    BrokenParts = 146,
    NeedsExtension = 147,
    TooMuchMesh = 148,
    TooMuchUnpacked = 149,
});
