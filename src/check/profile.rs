//! What counts as planar: limits, and the profiles that name common sets of them.

use std::fmt;

use crate::measure::Planarity;

/// A corner that lies off the plane of its face by no more than this part of the face's diameter is
/// rounding of the file: single precision, or seven digits.
pub const ROUNDED: f64 = 1e-5;

/// A named set of planarity limits (`operators.md` 11). They are kerfold's own defaults, not norms:
/// ask your supplier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, clap::ValueEnum)]
pub enum Profile {
    /// Planar up to rounding: 1e-9 of the face's diameter. For models made by kerfold; files with
    /// few digits fail it.
    Exact,
    /// 2 per mille of the face's diameter, and 1 mm.
    #[default]
    Glass,
    /// 1 mm.
    Plywood,
    /// 0.5 degrees.
    Paper,
    /// As glass, with what a glass shop grinds: corners of 15 degrees, edges of 50 mm, mitres of 60
    /// degrees.
    Glazier,
    /// As plywood, with what a saw cuts: corners of 10 degrees, edges of 20 mm, mitres of 60
    /// degrees.
    Joiner,
}

impl Profile {
    /// The profiles of planarity; those of shops hold to one of them.
    pub const ALL: [Self; 4] = [Self::Exact, Self::Glass, Self::Plywood, Self::Paper];

    /// The limits that the profile sets.
    pub fn limits(self) -> Limits {
        match self {
            Self::Exact => Limits { permille: Some(1e-6), ..Limits::default() },
            Self::Glass => Limits { mm: Some(1.0), permille: Some(2.0), ..Limits::default() },
            Self::Plywood => Limits { mm: Some(1.0), ..Limits::default() },
            Self::Paper => Limits { degrees: Some(0.5), ..Limits::default() },
            Self::Glazier => Limits {
                min_angle_degrees: Some(15.0),
                min_edge_mm: Some(50.0),
                max_mitre_degrees: Some(60.0),
                ..Self::Glass.limits()
            },
            Self::Joiner => Limits {
                min_angle_degrees: Some(10.0),
                min_edge_mm: Some(20.0),
                max_mitre_degrees: Some(60.0),
                ..Self::Plywood.limits()
            },
        }
    }

    /// The name as it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Glass => "glass",
            Self::Plywood => "plywood",
            Self::Paper => "paper",
            Self::Glazier => "glazier",
            Self::Joiner => "joiner",
        }
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The largest allowed value of each measure; `None` sets no limit. A value equal to its limit is
/// allowed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    /// Distance of a corner from the least-squares plane, in mm.
    pub mm: Option<f64>,
    /// The same in per mille of the face's diameter.
    pub permille: Option<f64>,
    /// Angle between the face's normal and a corner normal, in degrees.
    pub degrees: Option<f64>,
    /// Smallest angle at a corner of a face, in degrees.
    pub min_angle_degrees: Option<f64>,
    /// Shortest edge, in mm.
    pub min_edge_mm: Option<f64>,
    /// Largest mitre, half of the fold angle, in degrees.
    pub max_mitre_degrees: Option<f64>,
}

/// A limit that a face breaks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Breach {
    /// What was measured.
    pub measured: f64,
    /// What is allowed.
    pub limit: f64,
    /// The unit of both.
    pub unit: Unit,
}

impl Limits {
    /// Whether a face keeps all limits.
    pub fn allow(&self, planarity: &Planarity) -> bool {
        self.measures(planarity).all(|m| m.measured <= m.limit)
    }

    /// The limit that a face breaks worst, by measured / limit; `None` when it keeps all.
    pub fn breach(&self, planarity: &Planarity) -> Option<Breach> {
        let broken = self.measures(planarity).filter(|m| m.measured > m.limit);
        broken.reduce(|worst, m| if m.share() > worst.share() { m } else { worst })
    }

    /// How much of its tightest limit a face uses: above 1 it breaks it. Zero when there is no
    /// limit.
    pub fn share(&self, planarity: &Planarity) -> f64 {
        self.measures(planarity).map(|m| m.share()).fold(0.0, f64::max)
    }

    fn measures(&self, planarity: &Planarity) -> impl Iterator<Item = Breach> {
        let measures = [
            (planarity.mm, self.mm, Unit::Mm),
            (planarity.permille, self.permille, Unit::Permille),
            (planarity.degrees, self.degrees, Unit::Degrees),
        ];
        measures
            .into_iter()
            .filter_map(|(measured, limit, unit)| Some(Breach { measured, limit: limit?, unit }))
    }
}

impl Breach {
    fn share(&self) -> f64 {
        if self.measured == 0.0 { 0.0 } else { self.measured / self.limit }
    }
}

/// The unit of a measured value and its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Unit {
    /// Millimetres.
    Mm,
    /// Thousandths of the face's diameter.
    Permille,
    /// Degrees.
    Degrees,
    /// A number of edges.
    Edges,
    /// A number of sides of a face.
    Sides,
    /// A number of connected parts.
    Components,
    /// A number of handles.
    Handles,
    /// A number of rims.
    Rims,
    /// A number of vertices.
    Vertices,
    /// A number of faces.
    Faces,
    /// A number of places where an outline meets itself.
    Contacts,
    /// A number of times that a surface winds around its middle.
    Windings,
    /// Cubic millimetres.
    CubicMm,
}

impl Unit {
    /// The name as files show it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Permille => "permille",
            Self::Degrees => "degrees",
            Self::Edges => "edges",
            Self::Sides => "sides",
            Self::Components => "components",
            Self::Handles => "handles",
            Self::Rims => "rims",
            Self::Vertices => "vertices",
            Self::Faces => "faces",
            Self::Contacts => "contacts",
            Self::Windings => "windings",
            Self::CubicMm => "mm³",
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_needs_both_limits_and_the_worst_one_is_named() {
        let limits = Profile::Glass.limits();
        let face = |mm, permille| Planarity { mm, permille, degrees: 90.0, percent: None };
        assert!(limits.allow(&face(1.0, 2.0)));
        let large = limits.breach(&face(1.5, 0.5)).expect("too far");
        assert_eq!((large.measured, large.limit, large.unit), (1.5, 1.0, Unit::Mm));
        let small = limits.breach(&face(0.01, 3.0)).expect("too skew");
        assert_eq!((small.measured, small.limit, small.unit), (3.0, 2.0, Unit::Permille));
        assert_eq!(limits.breach(&face(1.5, 8.0)).expect("both").unit, Unit::Permille);
        assert_eq!(limits.share(&face(0.5, 0.2)), 0.5);
    }

    #[test]
    fn a_limit_of_zero_allows_zero_only() {
        let limits = Limits { mm: Some(0.0), ..Limits::default() };
        assert!(limits.allow(&Planarity::default()));
        assert_eq!(limits.share(&Planarity::default()), 0.0);
        assert!(limits.breach(&Planarity { mm: 1e-300, ..Planarity::default() }).is_some());
    }
}
