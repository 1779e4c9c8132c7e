//! Solids that can be written and read: no two vertices at one point, also in the simple form.
//!
//! Where more than three planes meet, the simple form has several vertices. To lie apart they need
//! planes that do not meet in one point, so the planes there are moved inwards, each by an amount
//! of its own, tiny against the solid: a moved plane keeps its direction, and what lies inside the
//! moved planes lies inside the given ones.

use super::GoesOn;
use super::half_space::HalfSpace;
use super::halfspaces::{Form, HalfSpaceError, Intersect, Numbers, intersect_verified};
use super::polytope::Polytope;

/// Planes are moved by less than this share of the diagonal of the solid's box.
const MOVE: f64 = 1.0 / (1_u64 << 15) as f64;
/// Edges of this share of it are long enough, so that single precision keeps their ends apart.
const LONG_ENOUGH: f64 = 1.0 / (1_u64 << 21) as f64;
/// Edges of fewer rounding bounds are too short.
const LEAST_BOUNDS: f64 = 16.0;
/// So many sets of amounts are tried.
const TRIES: u32 = 12;
/// The fractional parts of its multiples by squares are spread evenly and have no pattern.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A solid with all vertices apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Apart {
    /// The solid.
    pub polytope: Polytope,
    /// Its half-spaces, some moved inwards.
    pub half_spaces: Vec<HalfSpace>,
    /// The numbers of those that were moved, ascending.
    pub moved: Vec<u32>,
}

/// Intersects half-spaces to a solid of which no two vertices of an edge lie nearer together than
/// rounding can tell apart, compared with all half-spaces.
///
/// Vertices nearer than that are one even where the numbers are taken as given. In the simple form,
/// where more than three planes meet, those of the first `movable` half-spaces among them are moved
/// inwards by at most 1/32 768 of the diagonal of the solid's box. Everything else is as with
/// [`intersect_verified`].
///
/// # Errors
/// [`HalfSpaceError`] as [`intersect_verified`], and [`HalfSpaceError::NotSimple`].
pub fn intersect_apart(
    half_spaces: &[HalfSpace],
    options: &Intersect,
    movable: usize,
    goes_on: GoesOn<'_>,
) -> Result<Apart, HalfSpaceError> {
    let as_given = intersect_verified(half_spaces, options, goes_on)?;
    if as_given.shortest_edge() > as_given.rounding().max(options.resolution) {
        let half_spaces = half_spaces.to_vec();
        return Ok(Apart { polytope: as_given, half_spaces, moved: Vec::new() });
    }
    drop(as_given);
    let joined = Intersect { form: Form::Merged, numbers: Numbers::Constructed, ..*options };
    let polytope = intersect_verified(half_spaces, &joined, goes_on)?;
    let crowded = match options.form {
        Form::Merged => Vec::new(),
        Form::Simple => crowded_planes(&polytope, movable),
    };
    if crowded.is_empty() {
        return Ok(Apart { polytope, half_spaces: half_spaces.to_vec(), moved: crowded });
    }
    let simple = Crowded { half_spaces, options: joined, polytope, crowded };
    simple.moved_apart(goes_on)
}

/// A solid with vertices of more than three edges.
struct Crowded<'a> {
    half_spaces: &'a [HalfSpace],
    options: Intersect,
    polytope: Polytope,
    /// The planes there, those that may move.
    crowded: Vec<u32>,
}

impl Crowded<'_> {
    /// The best of a few ways to move the planes: that with the longest shortest edge.
    fn moved_apart(self, goes_on: GoesOn<'_>) -> Result<Apart, HalfSpaceError> {
        let size = extent(&self.polytope);
        // A face that is smaller than the way that planes are moved would be lost.
        let reach = (size * MOVE).min(self.polytope.shortest_edge() / 8.0);
        let enough = (size * LONG_ENOUGH).min(reach / 64.0);
        let rounding = self.polytope.rounding().max(self.options.resolution);
        let least = (LEAST_BOUNDS * rounding).min(enough);
        // A face that is narrower than the planes move may go; better are ways that keep all.
        let mut best: Option<(bool, f64, Apart)> = None;
        for attempt in 0..TRIES {
            let half_spaces = self.moved(attempt, reach / f64::from(1 << (attempt / 3 * 2)));
            let polytope = intersect_verified(&half_spaces, &self.options, goes_on)?;
            let has_all_faces = polytope.half_spaces == self.polytope.half_spaces;
            let shortest = polytope.shortest_edge();
            let is_better = best.as_ref().is_none_or(|b| (has_all_faces, shortest) > (b.0, b.1));
            if is_better && is_simple(&polytope) && shortest >= least {
                let apart = Apart { polytope, half_spaces, moved: Vec::new() };
                best = Some((has_all_faces, shortest, apart));
            }
            if best.as_ref().is_some_and(|b| b.0 && b.1 >= enough) {
                break;
            }
        }
        let (_, _, best) = best.ok_or(HalfSpaceError::NotSimple { least })?;
        Ok(Apart { moved: self.crowded, ..best })
    }

    /// The half-spaces with those that are crowded moved inwards, each by an amount of its own
    /// between half of `reach` and that.
    fn moved(&self, attempt: u32, reach: f64) -> Vec<HalfSpace> {
        let mut moved = self.half_spaces.to_vec();
        for (&i, k) in self.crowded.iter().zip(1_u32..) {
            let k = f64::from(k);
            let share = (k * (k + 0.371 * f64::from(attempt)) * GOLDEN).fract();
            let h = &mut moved[i as usize];
            h.offset -= h.normal.length() * reach * (1.0 + share) / 2.0;
        }
        moved
    }
}

/// The half-spaces below `movable` with a face at a vertex where more than three meet, ascending.
fn crowded_planes(polytope: &Polytope, movable: usize) -> Vec<u32> {
    let valence = valence(polytope);
    let is_crowded = |run: &[u32]| run.iter().any(|&v| valence[v as usize] > 3);
    let faces = polytope.half_spaces.iter().zip(polytope.faces.iter());
    faces.filter(|(i, run)| (**i as usize) < movable && is_crowded(run)).map(|(&i, _)| i).collect()
}

fn is_simple(polytope: &Polytope) -> bool {
    valence(polytope).iter().all(|&n| n == 3)
}

/// How many faces meet at each vertex.
fn valence(polytope: &Polytope) -> Vec<u32> {
    let mut valence = vec![0; polytope.vertices.len()];
    polytope.faces.corners().iter().for_each(|&v| valence[v as usize] += 1);
    valence
}

/// The diagonal of the box.
fn extent(polytope: &Polytope) -> f64 {
    let low = polytope.vertices.iter().copied().reduce(glam::DVec3::min).unwrap_or_default();
    let high = polytope.vertices.iter().copied().reduce(glam::DVec3::max).unwrap_or_default();
    (high - low).length()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn apart(half_spaces: &[HalfSpace], form: Form) -> Apart {
        let options = Intersect { form, ..Intersect::default() };
        intersect_apart(half_spaces, &options, half_spaces.len(), &|| true).expect("a solid")
    }

    #[test]
    fn a_pyramid_gets_a_short_ridge() {
        let side = |x, y| HalfSpace { normal: DVec3::new(x, y, 1.0), offset: 4.0 };
        let base = HalfSpace { normal: DVec3::NEG_Z, offset: 0.0 };
        let planes = [side(1.0, 0.0), side(-1.0, 0.0), side(0.0, 1.0), side(0.0, -1.0), base];
        let merged = apart(&planes, Form::Merged);
        assert_eq!((merged.polytope.vertices.len(), merged.moved.len()), (5, 0));
        let simple = apart(&planes, Form::Simple);
        assert_eq!((simple.polytope.vertices.len(), simple.polytope.faces.len()), (6, 5));
        assert_eq!(simple.moved, [0, 1, 2, 3]);
        let shortest = simple.polytope.shortest_edge();
        assert!(shortest > 1e-6 && shortest < 1e-3, "{shortest:e}");
        // Inside all given planes.
        assert_eq!(simple.polytope.beyond(&planes, &[0, 1, 2, 3, 4], 0.0), []);
    }

    /// The six planes of a cube about the origin.
    fn cube() -> Vec<HalfSpace> {
        let sides = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        sides.map(|normal| HalfSpace { normal, offset: 1.0 }).collect()
    }

    #[test]
    fn chamfers_below_rounding_make_no_short_edges() {
        // One along an edge, one across a corner: each takes off less than coordinates show.
        let mut planes = cube();
        planes.push(HalfSpace { normal: DVec3::new(1.0, 1.0, 0.0), offset: 2.0 - 1e-13 });
        planes.push(HalfSpace { normal: DVec3::NEG_ONE, offset: 3.0 - 1e-13 });
        for form in [Form::Merged, Form::Simple] {
            let made = apart(&planes, form);
            assert_eq!((made.polytope.vertices.len(), made.polytope.faces.len()), (8, 6));
            assert!(made.polytope.shortest_edge() > 1.9 && made.moved.is_empty());
        }
        // A thousand times as much is a face.
        planes[6].offset = 2.0 - 1e-10;
        assert_eq!(apart(&planes, Form::Merged).polytope.faces.len(), 7);
    }

    #[test]
    fn who_says_stop_gets_no_solid() {
        let stopped = intersect_apart(&cube(), &Intersect::default(), 6, &|| false);
        assert_eq!(stopped, Err(HalfSpaceError::Stopped));
    }
}
