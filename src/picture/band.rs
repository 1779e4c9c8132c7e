//! A band of rows of the picture: depth buffer, faces, visible parts of lines.
//!
//! A picture is drawn band by band, so that the buffer stays small however large the picture is. A
//! band sees some rows beyond its own ones, so that lines near its border come out as in its
//! neighbour.

use glam::{DVec2, DVec3};

use super::marks::{Owner, Rank, Tag};
use super::paint::{self, Light};
use super::scene::{Dot, Facet, Ink, Line, Scene, touches};
use crate::mesh::{FaceId, Mesh};

/// Rows of a band, in pixels.
pub(super) const BAND_ROWS: usize = 64;
/// Samples per pixel along each side.
const SAMPLES: usize = 3;
/// What is in front by less than this, in pixels, is in front by rounding.
const ROUNDING: f64 = 0.02;
/// No facet.
const NONE: u32 = u32::MAX;
/// Strength of hidden lines in x-rays.
pub(super) const HIDDEN: f32 = 0.35;
/// Directions in which shadows are looked for: every 30°, written out so that they are the same on
/// every machine.
const DIRECTIONS: [[f64; 2]; 12] = [
    [1.0, 0.0],
    [ROOT, 0.5],
    [0.5, ROOT],
    [0.0, 1.0],
    [-0.5, ROOT],
    [-ROOT, 0.5],
    [-1.0, 0.0],
    [-ROOT, -0.5],
    [-0.5, -ROOT],
    [0.0, -1.0],
    [0.5, -ROOT],
    [ROOT, -0.5],
];
/// Half the root of 3.
const ROOT: f64 = 0.866_025_403_784_438_6;

/// The depth buffer of one band.
pub(super) struct Band<'a> {
    scene: &'a Scene,
    /// Width of the picture in pixels.
    width: usize,
    /// The rows of the picture that this band is for.
    rows: std::ops::Range<usize>,
    /// Rows seen beyond them on either side.
    halo: usize,
    depths: Vec<f32>,
    facets: Vec<u32>,
    /// How many facets lie over a sample, for x-rays; else empty.
    layers: Vec<u8>,
    /// What is pointed out most and nearest at a sample, for x-rays; else empty.
    marked: Vec<u32>,
}

impl<'a> Band<'a> {
    /// Draws the faces into the depth buffer of the rows.
    pub fn new(scene: &'a Scene, width: usize, rows: std::ops::Range<usize>) -> Self {
        let widest = scene.lines.iter().map(|line| line.width).fold(0.0, f64::max);
        let halo = ((widest / 2.0).max(scene.shadow)).ceil() as usize + 3;
        let samples = width * SAMPLES * (rows.len() + 2 * halo) * SAMPLES;
        let depths = vec![f32::NEG_INFINITY; samples];
        let layers = vec![0; if scene.is_x_ray { samples } else { 0 }];
        let has_marks = scene.is_x_ray && scene.facets.iter().any(|f| f.rank > Rank::Plain);
        let marked = vec![NONE; if has_marks { samples } else { 0 }];
        let facets = vec![NONE; samples];
        let mut band = Self { scene, width, rows, halo, depths, facets, layers, marked };
        let mut crossings = Vec::new();
        for (i, facet) in scene.facets.iter().enumerate() {
            band.fill(facet, i as u32, &mut crossings);
        }
        band
    }

    /// The first row of the buffer, in pixels.
    fn top(&self) -> f64 {
        self.rows.start as f64 - self.halo as f64
    }

    /// The row after the last one of the buffer, in pixels.
    fn bottom(&self) -> f64 {
        (self.rows.end + self.halo) as f64
    }

    /// The first row of samples, counted from the top of the picture. Samples are placed by these
    /// whole numbers, so that bands agree to the last bit.
    fn first_sample_row(&self) -> i64 {
        (self.rows.start as i64 - self.halo as i64) * SAMPLES as i64
    }

    /// Where a row of samples of the buffer lies, in pixels.
    fn sample_y(&self, row: usize) -> f64 {
        ((self.first_sample_row() + row as i64) as f64 + 0.5) / SAMPLES as f64
    }

    /// Fills a facet by the even-odd rule, so that concave ones and ones with slits need no
    /// cutting.
    fn fill(&mut self, facet: &Facet, id: u32, crossings: &mut Vec<f64>) {
        if facet.bottom <= self.top() || facet.top >= self.bottom() {
            return;
        }
        let per_pixel = SAMPLES as f64;
        let sample_rows = self.depths.len() / (self.width * SAMPLES);
        let first = self.first_sample_row() as f64;
        let row_of =
            |y: f64| ((y * per_pixel - 0.5).ceil() - first).clamp(0.0, sample_rows as f64) as usize;
        for row in row_of(facet.top)..row_of(facet.bottom) {
            cross(&self.scene.corners[facet.corners.clone()], self.sample_y(row), crossings);
            for span in crossings.chunks_exact(2) {
                self.fill_span(facet, id, row, [span[0], span[1]]);
            }
        }
    }

    fn fill_span(&mut self, facet: &Facet, id: u32, row: usize, span: [f64; 2]) {
        let per_pixel = SAMPLES as f64;
        let columns = self.width * SAMPLES;
        let [from, to] =
            span.map(|x| (x * per_pixel - 0.5).ceil().clamp(0.0, columns as f64) as usize);
        let y = self.sample_y(row);
        for column in from..to {
            let depth = facet.depth((column as f64 + 0.5) / per_pixel, y) as f32;
            let sample = row * columns + column;
            if facet.rank > Rank::Plain && !self.marked.is_empty() {
                self.mark(sample, id, [(column as f64 + 0.5) / per_pixel, y]);
                continue;
            }
            if let Some(layers) = self.layers.get_mut(sample) {
                *layers = layers.saturating_add(1);
            }
            if depth > self.depths[sample] {
                self.depths[sample] = depth;
                self.facets[sample] = id;
            }
        }
    }

    /// Lays a facet that is pointed out over a sample of an x-ray, if it counts more than what lies
    /// there or is nearer.
    fn mark(&mut self, sample: usize, id: u32, [x, y]: [f64; 2]) {
        let order = |id: u32| {
            let facet = &self.scene.facets[id as usize];
            (facet.rank, facet.depth(x, y))
        };
        let old = self.marked[sample];
        let counts = old == NONE || {
            let ((rank, depth), (old_rank, old_depth)) = (order(id), order(old));
            rank > old_rank || (rank == old_rank && depth > old_depth)
        };
        if counts {
            self.marked[sample] = id;
        }
    }

    /// The light of a pixel of the band's own rows: the mean of its samples.
    pub fn light(&self, x: usize, y: usize, paper: Light) -> Light {
        let columns = self.width * SAMPLES;
        let first = (y - self.rows.start + self.halo) * SAMPLES * columns + x * SAMPLES;
        let samples = (0..SAMPLES * SAMPLES).map(|i| {
            let (row, column) = (i / SAMPLES, i % SAMPLES);
            let per_pixel = SAMPLES as f64;
            let place = [
                x as f64 + (column as f64 + 0.5) / per_pixel,
                y as f64 + (row as f64 + 0.5) / per_pixel,
            ];
            self.sample_light(first + row * columns + column, place, paper)
        });
        let light = samples.sum::<Light>() / (SAMPLES * SAMPLES) as f32;
        if self.scene.shadow > 0.0 { light * self.openness(x, y) } else { light }
    }

    fn sample_light(&self, sample: usize, [x, y]: [f64; 2], paper: Light) -> Light {
        let id = self.facets[sample];
        let own = |id: u32| self.scene.light(id as usize, x, y);
        let plain = match self.layers.get(sample) {
            _ if id == NONE => paper,
            // Every surface on the way takes a little of the light.
            Some(&layers) => paper.lerp(own(id), 0.55) * 0.94_f32.powi(i32::from(layers.min(24))),
            None => own(id),
        };
        match self.marked.get(sample) {
            Some(&over) if over != NONE => {
                plain.lerp(own(over), self.scene.facets[over as usize].rank.cover())
            }
            _ => plain,
        }
    }

    /// How much of the light reaches a pixel past what stands around it: 1 in the open. Depths of
    /// points around it on two circles are compared with its own (ambient occlusion in the picture:
    /// Mittring 2007).
    fn openness(&self, x: usize, y: usize) -> f32 {
        let depth_at = |dx: f64, dy: f64| {
            let column = (x as f64 + 0.5 + dx) * SAMPLES as f64;
            let row = (y as f64 + 0.5 + dy) * SAMPLES as f64 - self.first_sample_row() as f64;
            let columns = self.width * SAMPLES;
            let rows = self.depths.len() / columns;
            let is_in = column >= 0.0 && row >= 0.0;
            let (column, row) = (column as usize, row as usize);
            let depth = (is_in && column < columns && row < rows)
                .then(|| f64::from(self.depths[row * columns + column]));
            depth.filter(|depth| depth.is_finite())
        };
        let Some(own) = depth_at(0.0, 0.0) else { return 1.0 };
        let reach = self.scene.shadow;
        let mut hidden = 0.0;
        for [dx, dy] in DIRECTIONS {
            for share in [0.4, 1.0] {
                let [dx, dy] = [dx, dy].map(|d| d * share * reach);
                let rise = depth_at(dx, dy).map_or(0.0, |depth| depth - own);
                // What stands much nearer is another part of the model: it darkens less.
                let slope = rise / (share * reach);
                hidden += (slope - 0.3).clamp(0.0, 1.0) / (1.0 + 0.2 * slope.max(0.0));
            }
        }
        1.0 - 0.75 * (hidden / (2 * DIRECTIONS.len()) as f64) as f32
    }

    /// Whether nothing of the model is seen at the middle of a pixel of the band's own rows.
    pub fn is_background(&self, x: usize, y: usize) -> bool {
        let columns = self.width * SAMPLES;
        let row = (y - self.rows.start + self.halo) * SAMPLES + SAMPLES / 2;
        self.facets[row * columns + x * SAMPLES + SAMPLES / 2] == NONE
    }

    /// Whether something at `place` is seen that belongs to the faces which `owns` accepts: one of
    /// them is seen within a pixel, or nothing is in front. Outlines are also seen beside the
    /// background: on fine meshes their own faces are often too narrow for a sample.
    fn sees(&self, place: DVec3, is_outline: bool, owns: impl Fn(FaceId) -> bool) -> bool {
        let columns = (self.width * SAMPLES) as i64;
        let rows = self.depths.len() as i64 / columns;
        let column = (place.x * SAMPLES as f64).floor() as i64;
        let row = (place.y * SAMPLES as f64).floor() as i64 - self.first_sample_row();
        let facet = |row: i64, column: i64| {
            let is_in = (0..rows).contains(&row) && (0..columns).contains(&column);
            is_in.then(|| self.facets[(row * columns + column) as usize])
        };
        // The sight of the own faces is surer than depths: no bias, no stipple, and a hidden edge
        // that leaves from a visible corner does not peep out.
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (row + i, column + j)));
        let near = around.filter_map(|(row, column)| facet(row, column));
        let mut last = NONE - 1;
        for id in near {
            if id != last
                && (if id == NONE { is_outline } else { owns(self.scene.facets[id as usize].face) })
            {
                return true;
            }
            last = id;
        }
        // Faces too narrow for a sample: what is seen here must not lie in front.
        facet(row, column).filter(|&id| id != NONE).is_none_or(|id| {
            let in_front = self.scene.facets[id as usize].depth(place.x, place.y) - place.z;
            in_front <= ROUNDING
        })
    }

    /// Draws the visible parts of the lines into the coverage of the band's own rows.
    pub fn draw_lines(&self, coverage: &mut Coverage) {
        for line in &self.scene.lines {
            if self.scene.is_x_ray {
                // What is pointed out is seen through everything.
                let share = if line.ink == Ink::Mark { 1.0 } else { HIDDEN };
                let pale = Line { strength: share * line.strength, ..line.clone() };
                coverage.draw(line.ends[0].truncate(), line.ends[1].truncate(), &pale);
            }
            for [from, to] in self.visible_parts(line) {
                coverage.draw(from, to, line);
            }
        }
    }

    /// The visible parts of a line near the band. Tested at steps that depend on the line alone, so
    /// that neighbouring bands find the same.
    pub fn visible_parts(&self, line: &Line) -> Vec<[DVec2; 2]> {
        let [a, b] = line.ends;
        let (top, bottom) = (self.top() + 1.0, self.bottom() - 1.0);
        if a.y.max(b.y) < top || a.y.min(b.y) > bottom {
            return Vec::new();
        }
        let length = a.truncate().distance(b.truncate());
        let steps = (length * 1.5).ceil().max(1.0);
        // The steps within the band; all of them when the line is level.
        let [t, u] = [top, bottom].map(|y| (y - a.y) / (b.y - a.y));
        let (enter, leave) = if a.y == b.y { (0.0, 1.0) } else { (t.min(u), t.max(u)) };
        let (first, last) = ((enter.max(0.0) * steps).floor(), (leave.min(1.0) * steps).ceil());
        let owns = |f: FaceId| f == line.faces[0] || f == line.faces[1];
        let point = |t: f64| a.lerp(b, (t / steps).clamp(0.0, 1.0));
        let mut parts = Vec::new();
        let mut start = None;
        for i in 0..=(last - first) as usize {
            let t = first + i as f64;
            let is_seen = self.sees(point(t), line.is_outline, owns);
            if is_seen && start.is_none() {
                start = Some(t);
            }
            if let Some(from) = start.filter(|_| !is_seen || t == last) {
                let to = if is_seen { t } else { t - 0.5 };
                let from = if from == first { from } else { from - 0.5 };
                parts.push([point(from).truncate(), point(to).truncate()]);
                start = None;
            }
        }
        parts
    }

    /// The visible numbers whose middle is in the band's own rows.
    pub fn visible_tags(&self, mesh: &Mesh) -> Vec<&'a Tag> {
        let rows = self.rows.start as f64..self.rows.end as f64;
        let tags = self.scene.tags.iter().filter(|tag| rows.contains(&tag.place.y));
        let is_seen = |tag: &&Tag| match tag.owner {
            _ if self.scene.is_x_ray => true,
            Owner::Vertex(v) => self.sees(tag.place, false, |f| touches(mesh, v, f)),
            Owner::Edge(faces) => self.sees(tag.place, false, |f| faces.contains(&f)),
            Owner::Face(face) => self.sees(tag.place, false, |f| f == face),
        };
        tags.filter(is_seen).collect()
    }

    /// The visible dots whose middle is in the band's own rows.
    pub fn visible_dots(&self, mesh: &Mesh) -> Vec<&'a Dot> {
        let rows = self.rows.start as f64..self.rows.end as f64;
        let dots = self.scene.dots.iter().filter(|dot| rows.contains(&dot.place.y));
        dots.filter(|dot| {
            self.scene.is_x_ray || self.sees(dot.place, false, |f| touches(mesh, dot.vertex, f))
        })
        .collect()
    }
}

/// Where the outline of a facet crosses a row, ascending. Both faces of an edge compute the same
/// numbers, so no gap opens between them.
fn cross(corners: &[DVec3], y: f64, crossings: &mut Vec<f64>) {
    crossings.clear();
    let Some(mut a) = corners.last() else { return };
    for b in corners {
        if (a.y <= y) != (b.y <= y) {
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            crossings.push(low.x + (y - low.y) * ((high.x - low.x) / (high.y - low.y)));
        }
        a = b;
    }
    crossings.sort_unstable_by(f64::total_cmp);
}

/// How much of each pixel of a band is covered by lines. Where lines meet, the stronger counts, so
/// joints do not darken.
pub(super) struct Coverage {
    width: usize,
    rows: std::ops::Range<usize>,
    /// By ink.
    inks: [Vec<f32>; 4],
}

impl Coverage {
    /// Nothing covered yet.
    pub fn new(width: usize, rows: std::ops::Range<usize>) -> Self {
        let none = vec![0.0; width * rows.len()];
        Self { width, rows, inks: [none.clone(), none.clone(), none.clone(), none] }
    }

    /// Covers the pixels within half a line width of the segment, softly over one pixel, with round
    /// ends.
    fn draw(&mut self, from: DVec2, to: DVec2, line: &Line) {
        // Thinner than a pixel is a pixel of less strength.
        let half = line.width.max(1.0) / 2.0;
        let strength = line.strength * line.width.min(1.0) as f32;
        let reach = half + 0.5;
        let along = to - from;
        let scale = along.length_squared().recip();
        let rows = [from.y.min(to.y) - reach, from.y.max(to.y) + reach];
        let [first, end] = rows
            .map(|y| (y.floor().clamp(0.0, 1e9) as usize).clamp(self.rows.start, self.rows.end));
        let pixels = &mut self.inks[line.ink as usize];
        for row in first..(end + 1).min(self.rows.end) {
            let y = row as f64 + 0.5;
            let [left, right] = reached(from, to, y, reach, self.width);
            for column in left..right {
                let p = DVec2::new(column as f64 + 0.5, y) - from;
                let t =
                    if scale.is_finite() { (p.dot(along) * scale).clamp(0.0, 1.0) } else { 0.0 };
                let cover = (reach - p.distance(along * t)).clamp(0.0, 1.0) as f32 * strength;
                let pixel = &mut pixels[(row - self.rows.start) * self.width + column];
                *pixel = pixel.max(cover);
            }
        }
    }

    /// Lays the lines over the light of a pixel.
    pub fn over(&self, x: usize, y: usize, light: Light) -> Light {
        let i = (y - self.rows.start) * self.width + x;
        let colours = [Ink::Plane, Ink::Edge, Ink::Rim, Ink::Mark].map(|ink| (ink, ink.colour()));
        colours.into_iter().fold(light, |light, (ink, colour)| {
            light.lerp(paint::ink(colour), self.inks[ink as usize][i])
        })
    }
}

/// The columns of the pixels of a row that a segment can reach.
fn reached(from: DVec2, to: DVec2, y: f64, reach: f64, width: usize) -> [usize; 2] {
    let x_at = |y: f64| {
        let t = if from.y == to.y { 0.0 } else { (y - from.y) / (to.y - from.y) };
        from.x + (to.x - from.x) * t.clamp(0.0, 1.0)
    };
    let ends = if from.y == to.y { [from.x, to.x] } else { [x_at(y - reach), x_at(y + reach)] };
    let columns = [ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach + 1.0];
    columns.map(|x| x.floor().clamp(0.0, width as f64) as usize)
}
