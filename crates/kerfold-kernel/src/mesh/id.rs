//! Ids: u32 newtypes, and dense side tables indexed by them.

use std::fmt;
use std::ops::{Index, IndexMut};

/// An id that can index a [`SideTable`].
pub trait Id: Copy {
    /// The position in a dense table.
    fn index(self) -> usize;
}

macro_rules! id {
    ($(#[$doc:meta])* $name:ident, $prefix:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            /// The id at a position of its table.
            ///
            /// # Panics
            /// When the position is beyond 2³¹ − 2.
            #[inline]
            pub fn new(index: usize) -> Self {
                Self(u32::try_from(index).ok().filter(|&i| i < super::MAX_ELEMENTS - 1).expect("a mesh holds fewer than 2^31 elements"))
            }

            /// The position in the table, as files and messages show it.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl Id for $name {
            #[inline]
            fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($prefix, "{}"), self.0)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// A vertex of a mesh.
    VertexId,
    "v"
);
id!(
    /// A half-edge: one of the two directed sides of an edge. It leaves its origin and has its face
    /// on the left.
    HalfEdgeId,
    "h"
);
id!(
    /// An edge: a pair of half-edges.
    EdgeId,
    "e"
);
id!(
    /// A face, or a hole (the rim of an open surface).
    FaceId,
    "f"
);

impl HalfEdgeId {
    /// The other side of the same edge.
    #[inline]
    pub fn twin(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// The edge of which this is a side.
    #[inline]
    pub fn edge(self) -> EdgeId {
        EdgeId(self.0 >> 1)
    }
}

impl EdgeId {
    /// The two sides of the edge; the first is the one that the edge was made with.
    #[inline]
    pub fn half_edges(self) -> [HalfEdgeId; 2] {
        let first = HalfEdgeId(self.0 << 1);
        [first, first.twin()]
    }

    /// The first side of the edge.
    #[inline]
    pub fn half_edge(self) -> HalfEdgeId {
        HalfEdgeId(self.0 << 1)
    }
}

/// A dense table with one value for each id of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct SideTable<I, T> {
    values: Vec<T>,
    ids: std::marker::PhantomData<fn(I)>,
}

/// One value per vertex.
pub type VertexMap<T> = SideTable<VertexId, T>;
/// One value per half-edge.
pub type HalfEdgeMap<T> = SideTable<HalfEdgeId, T>;
/// One value per edge.
pub type EdgeMap<T> = SideTable<EdgeId, T>;
/// One value per face or hole.
pub type FaceMap<T> = SideTable<FaceId, T>;

impl<I: Id, T> SideTable<I, T> {
    /// A table of `slots` copies of `value`; take `slots` from the mesh
    /// ([`super::Mesh::vertex_slots`] and its kin).
    pub fn filled(slots: usize, value: T) -> Self
    where
        T: Clone,
    {
        Self { values: vec![value; slots], ids: std::marker::PhantomData }
    }

    /// The values in the order of their ids.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The value of `id`, or `None` when the table was made before the id was.
    pub fn get(&self, id: I) -> Option<&T> {
        self.values.get(id.index())
    }
}

impl<I: Id, T> Index<I> for SideTable<I, T> {
    type Output = T;
    #[inline]
    fn index(&self, id: I) -> &T {
        &self.values[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for SideTable<I, T> {
    #[inline]
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.values[id.index()]
    }
}
