//! From the dual hull to the faces of the solid: around each corner of the dual the faces there, in
//! order.
//!
//! Corners lie in memory as they were inserted, along the curve, the faces of the solid as the
//! half-spaces were given. So fans are walked in the order of the corners, where all they touch is
//! near, and the runs are carried to their places afterwards in one go. Far reads do not wait for
//! each other, far writes would.

use std::ops::Range;

use super::merge::Faces;
use super::parallel::fill_runs;
use super::polytope::Polygons;
use super::surface::{NONE, Surface, link};

/// So many fans are walked at the same time, since each step waits for the one before.
const LANES: usize = 4;
/// So many corners are copied at once, whether a face has that many or fewer: what is too much the
/// next face overwrites.
const BLOCK: usize = 12;

/// The dual faces around a point.
#[derive(Clone, Copy)]
struct Fan {
    /// A facet that has the point for a corner, as four times the facet plus which of its corners
    /// that is; `NONE` if there is none.
    start: u32,
    /// How many faces there are; none around a point that is no corner of the dual hull, inside a
    /// dual face or edge: its plane only touches the solid. Later where the run ends.
    size: u32,
}

/// The faces of the solid in the order of the dual points, as a step on the way: it is all that is
/// needed of the dual hull.
pub(super) struct Runs {
    /// For each half-space the size of its run and where that begins.
    sources: Vec<[u32; 2]>,
    runs: Vec<u32>,
}

impl Runs {
    /// For each dual point that is a corner the dual faces around it.
    pub(super) fn of(surface: &Surface<'_>, faces: &Faces, order: &[u32]) -> Self {
        let mut fans = fans(surface, faces, order.len());
        let mut sources = vec![[0_u32; 2]; order.len()];
        let mut total = 0;
        for (&i, fan) in order.iter().zip(&mut fans) {
            sources[i as usize] = [fan.size, total];
            total += fan.size;
            fan.size = total;
        }
        let walks = Walks { surface, faces, fans };
        let mut runs = vec![0; total as usize];
        fill_runs(
            &mut runs,
            order.len(),
            |place| walks.begin(place),
            |places, out| walks.write(places, out),
        );
        Self { sources, runs }
    }

    /// The faces in the order of the half-spaces, and which half-spaces they are of.
    pub(super) fn into_polygons(self) -> (Vec<u32>, Polygons) {
        let Self { sources, runs } = self;
        let (mut half_spaces, mut ends) =
            (Vec::with_capacity(sources.len()), Vec::with_capacity(sources.len()));
        let mut end = 0;
        for (i, &[size, _]) in (0..).zip(&sources).filter(|(_, source)| source[0] > 0) {
            end += size;
            half_spaces.push(i);
            ends.push(end);
        }
        let begin = |face: usize| if face == 0 { 0 } else { ends[face - 1] as usize };
        let mut corners = vec![0; runs.len()];
        fill_runs(&mut corners, ends.len(), begin, |own, out| {
            collect(half_spaces[own].iter().map(|&i| sources[i as usize]), &runs, out);
        });
        (half_spaces, Polygons::from_runs(corners, ends))
    }
}

/// Copies runs, each given by its size and where it begins, one behind the other.
fn collect(sources: impl Iterator<Item = [u32; 2]>, runs: &[u32], out: &mut [u32]) {
    let mut to = 0;
    for [size, from] in sources {
        let (size, from) = (size as usize, from as usize);
        let block = if size <= BLOCK && to + BLOCK <= out.len() && from + BLOCK <= runs.len() {
            BLOCK
        } else {
            size
        };
        if block == BLOCK {
            out[to..to + BLOCK].copy_from_slice(&runs[from..from + BLOCK]);
        } else {
            out[to..to + size].copy_from_slice(&runs[from..from + size]);
        }
        to += size;
    }
}

/// The fans of all points, by place.
fn fans(surface: &Surface<'_>, faces: &Faces, points: usize) -> Vec<Fan> {
    let mut fans = vec![Fan { start: NONE, size: 0 }; points];
    for f in surface.live() {
        for (v, corner) in surface.facet(f).corners.into_iter().zip(0..) {
            let fan = &mut fans[v as usize];
            *fan = Fan { start: link(f, corner), size: fan.size + 1 };
        }
    }
    if faces.has_merged() {
        let mut around = Vec::new();
        for (v, fan) in (0..).zip(&mut fans).filter(|(_, fan)| fan.size > 0) {
            faces.around(surface, v, fan.start >> 2, &mut around);
            fan.size = if around.len() > 2 { around.len() as u32 } else { 0 };
        }
    }
    fans
}

/// What the runs are written from.
struct Walks<'a> {
    surface: &'a Surface<'a>,
    faces: &'a Faces,
    fans: Vec<Fan>,
}

/// A fan that is walked, and where its faces go.
#[derive(Clone, Copy)]
struct Lane {
    point: u32,
    at: u32,
    begin: usize,
    size: usize,
    step: usize,
}

impl Walks<'_> {
    fn begin(&self, place: usize) -> usize {
        if place == 0 { 0 } else { self.fans[place - 1].size as usize }
    }

    /// Writes the runs of a share of the points: where nothing was merged, each facet around a
    /// point is a face.
    fn write(&self, places: Range<usize>, out: &mut [u32]) {
        let base = self.begin(places.start);
        let lane = |place: usize| {
            let (begin, Fan { start, size: end }) = (self.begin(place), self.fans[place]);
            Lane {
                point: place as u32,
                at: start,
                begin: begin - base,
                size: end as usize - begin,
                step: 0,
            }
        };
        if self.faces.has_merged() {
            places.for_each(|place| self.write_merged(lane(place), out));
            return;
        }
        let mut place = places.start;
        while place < places.end {
            let count = LANES.min(places.end - place);
            let mut lanes: [Lane; LANES] = std::array::from_fn(|i| lane(place + i.min(count - 1)));
            place += count;
            if lanes.iter().all(|lane| lane.size > 0) {
                let steps = lanes.iter().fold(0, |most, lane| lane.size.max(most));
                (0..steps).for_each(|_| lanes.iter_mut().for_each(|lane| self.step(lane, out)));
            } else {
                lanes[..count]
                    .iter_mut()
                    .for_each(|lane| (0..lane.size).for_each(|_| self.step(lane, out)));
            }
        }
    }

    /// Writes a face and goes to the next. After the last the first comes again, and is written
    /// again where it is: so fans of different sizes can be walked together without a branch.
    #[inline(always)]
    fn step(&self, lane: &mut Lane, out: &mut [u32]) {
        out[lane.begin + lane.step] = self.faces.of_facet(lane.at >> 2);
        lane.at = self.surface.next_around(lane.at);
        lane.step += 1;
        lane.step = if lane.step == lane.size { 0 } else { lane.step };
    }

    fn write_merged(&self, lane: Lane, out: &mut [u32]) {
        if lane.size > 0 {
            let mut around = Vec::with_capacity(lane.size);
            self.faces.around(self.surface, lane.point, lane.at >> 2, &mut around);
            out[lane.begin..lane.begin + lane.size].copy_from_slice(&around);
        }
    }
}
