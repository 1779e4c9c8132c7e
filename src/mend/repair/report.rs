//! What was repaired, in numbers and words.

use crate::units::counted;

/// A kind of repair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Repair {
    /// Vertices that lay together became one.
    Welded,
    /// Faces without area went.
    Empty,
    /// Faces that were there twice went.
    Doubled,
    /// Vertices on sides of other faces were taken into them.
    Junctions,
    /// Faces were turned around.
    Turned,
    /// The surface has one side only, and was cut open.
    OneSided,
    /// Edges at which more than two faces met were parted.
    PartedEdges,
    /// Vertices at which several fans of faces met were parted.
    PartedVertices,
    /// Holes were closed.
    ClosedHoles,
    /// Holes that could not be closed.
    LeftHoles,
    /// Parts were turned inside out.
    TurnedParts,
}

/// One kind of repair, and how often it was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mending {
    /// What was done.
    pub repair: Repair,
    /// To how many elements.
    pub count: usize,
}

/// All that was done, each kind once, in the order of the work.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Repairs {
    /// What was done.
    pub done: Vec<Mending>,
}

impl Repairs {
    pub(super) fn add(&mut self, repair: Repair, count: usize) {
        if count > 0 {
            self.done.push(Mending { repair, count });
        }
    }

    /// How often one kind of repair was done.
    pub fn count(&self, repair: Repair) -> usize {
        self.done.iter().find(|m| m.repair == repair).map_or(0, |m| m.count)
    }

    /// Whether there was nothing to do.
    pub fn is_nothing(&self) -> bool {
        self.done.is_empty()
    }
}

impl std::fmt::Display for Mending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = |one, many| counted(self.count, one, many);
        let text = match self.repair {
            Repair::Welded => count(
                "vertex lay at the place of another and became one with it",
                "vertices lay at the place of others and became one with them",
            ),
            Repair::Empty => {
                count("face had no area and was left out", "faces had no area and were left out")
            }
            Repair::Doubled => {
                count("face was there twice and stays once", "faces were there twice and stay once")
            }
            Repair::Junctions => count(
                "vertex on the side of a face became a corner of it (a T-junction)",
                "vertices on the sides of faces became corners of them (T-junctions)",
            ),
            Repair::Turned => count(
                "face looked the other way than its neighbours and was turned",
                "faces looked the other way than their neighbours and were turned",
            ),
            Repair::OneSided => count(
                "edge was cut open, since the surface has only one side (a Möbius strip)",
                "edges were cut open, since the surface has only one side (a Möbius strip)",
            ),
            Repair::PartedEdges => count(
                "edge had more than two faces and was parted",
                "edges had more than two faces and were parted",
            ),
            Repair::PartedVertices => count(
                "vertex was doubled where parts of the surface met in a point",
                "vertices were doubled where parts of the surface met in a point",
            ),
            Repair::ClosedHoles => count("hole was closed", "holes were closed"),
            Repair::LeftHoles => count(
                "hole is small enough but cannot be closed by one flat face or triangles",
                "holes are small enough but cannot be closed by one flat face or triangles",
            ),
            Repair::TurnedParts => count(
                "closed part was inside out and was turned",
                "closed parts were inside out and were turned",
            ),
        };
        f.write_str(&text)
    }
}
