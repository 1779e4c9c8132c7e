//! The assembly map: the model seen from the sides that its panels look at, every panel with its
//! name.
//!
//! Panels are drawn from the farthest to the nearest, filled, so that what lies behind is covered
//! (the painter's algorithm; by the middles of the panels, which is exact for all but panels that
//! reach around one another).

use glam::{DVec2, DVec3};

use super::plate::{Plate, Plates};
use crate::geom::polygon::{Location, bounds, centroid, locate, signed_area};
use crate::geom::triangulate;
use crate::net::PieceId;

/// A page of views.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyMap {
    /// Along x, in mm.
    pub width: f64,
    /// Along y, in mm.
    pub height: f64,
    /// The model's millimetres per millimetre of paper.
    pub scale: f64,
    /// The views, each in its own part of the page.
    pub views: Vec<MapView>,
}

/// The model from one side. Origin of the page is bottom left, y up.
#[derive(Debug, Clone, PartialEq)]
pub struct MapView {
    /// Which side, as `FRONT` or `TOP`.
    pub title: &'static str,
    /// Where the title begins.
    pub title_at: DVec2,
    /// The panels that look this way, the farthest first.
    pub panels: Vec<MapPanel>,
}

/// A panel on the page.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPanel {
    /// Which one.
    pub panel: PieceId,
    /// Its front.
    pub outline: Vec<DVec2>,
    /// The middle of its name.
    pub label_at: DVec2,
    /// The room for the name: length and height.
    pub room: DVec2,
}

/// A3, lying.
const PAGE: DVec2 = DVec2::new(420.0, 297.0);
const MARGIN: f64 = 10.0;
/// Room for a title below its view.
const TITLE: f64 = 8.0;

/// Sides: a name, where the viewer stands, and what is up on the page.
const SIDES: [(&str, DVec3, DVec3); 6] = [
    ("FRONT", DVec3::NEG_Y, DVec3::Z),
    ("RIGHT", DVec3::X, DVec3::Z),
    ("BACK", DVec3::Y, DVec3::Z),
    ("LEFT", DVec3::NEG_X, DVec3::Z),
    ("TOP", DVec3::Z, DVec3::Y),
    ("BOTTOM", DVec3::NEG_Z, DVec3::NEG_Y),
];

/// Panels are drawn when they look at the viewer with at least this cosine: beyond they are lines.
const FACING: f64 = 0.05;

/// Draws the map of a panelled model: all sides that are nearest to the direction of some panel.
pub fn assembly_map(plates: &Plates) -> AssemblyMap {
    let raw: Vec<RawView> = used_sides(plates).into_iter().map(|i| view(plates, i)).collect();
    let grid = Grid::new(raw.len());
    let largest =
        raw.iter().map(|v| v.high - v.low).fold(DVec2::splat(f64::MIN_POSITIVE), DVec2::max);
    let shrink = (grid.room() / largest).min_element();
    let views = raw.into_iter().enumerate().map(|(k, raw)| grid.placed(k, raw, shrink)).collect();
    AssemblyMap { width: PAGE.x, height: PAGE.y, scale: 1.0 / shrink, views }
}

/// The sides that are nearest to the direction of some panel.
fn used_sides(plates: &Plates) -> Vec<usize> {
    let nearest = |plate: &Plate| {
        let cosine = |i: usize| plate.frame.normal.dot(SIDES[i].1);
        (1..SIDES.len()).fold(0, |best, i| if cosine(i) > cosine(best) + 1e-9 { i } else { best })
    };
    let mut is_used = [false; SIDES.len()];
    plates.plates.iter().for_each(|plate| is_used[nearest(plate)] = true);
    (0..SIDES.len()).filter(|&i| is_used[i]).collect()
}

/// The page in rows of equal cells, one for each view, with a margin around each.
struct Grid {
    columns: usize,
    cell: DVec2,
}

impl Grid {
    fn new(views: usize) -> Self {
        let columns = (views as f64).sqrt().ceil().max(1.0) as usize;
        let rows = views.div_ceil(columns).max(1);
        let pitch = (PAGE - DVec2::splat(MARGIN)) / DVec2::new(columns as f64, rows as f64);
        Self { columns, cell: pitch - DVec2::splat(MARGIN) }
    }

    /// What a cell has for its view, above the title.
    fn room(&self) -> DVec2 {
        self.cell - DVec2::new(0.0, TITLE)
    }

    /// The lower left corner of a cell.
    fn corner(&self, k: usize) -> DVec2 {
        let (column, row) = (k % self.columns, k / self.columns);
        let from_top = PAGE.y - (row + 1) as f64 * (self.cell.y + MARGIN);
        DVec2::new(MARGIN + column as f64 * (self.cell.x + MARGIN), from_top)
    }

    /// A view in the middle of its cell.
    fn placed(&self, k: usize, raw: RawView, shrink: f64) -> MapView {
        let title_at = self.corner(k);
        let middle = title_at + DVec2::new(0.0, TITLE) + self.room() / 2.0;
        let on_page = |p: DVec2| middle + (p - raw.low.midpoint(raw.high)) * shrink;
        let panels = raw.panels.into_iter().map(|p| MapPanel {
            panel: p.panel,
            outline: p.outline.into_iter().map(on_page).collect(),
            label_at: on_page(p.label_at),
            room: p.room * shrink,
        });
        MapView { title: raw.title, title_at, panels: panels.collect() }
    }
}

/// A view in the model's millimetres, with its box.
struct RawView {
    title: &'static str,
    panels: Vec<MapPanel>,
    low: DVec2,
    high: DVec2,
}

/// The panels that look at one side.
fn view(plates: &Plates, side: usize) -> RawView {
    let (title, towards, up) = SIDES[side];
    let right = up.cross(towards);
    let flat = |p: DVec3| DVec2::new(p.dot(right), p.dot(up));
    let mut seen: Vec<(f64, MapPanel)> = Vec::new();
    for (i, plate) in plates.plates.iter().enumerate() {
        if plate.frame.normal.dot(towards) < FACING {
            continue;
        }
        let corners: Vec<DVec3> = plate.front.iter().map(|&p| plate.on_front(p)).collect();
        let depth = corners.iter().map(|p| p.dot(towards)).sum::<f64>() / corners.len() as f64;
        let outline: Vec<DVec2> = corners.into_iter().map(flat).collect();
        let (label_at, room) = label_room(&outline);
        seen.push((depth, MapPanel { panel: PieceId(i), outline, label_at, room }));
    }
    seen.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.panel.cmp(&b.1.panel)));
    let panels: Vec<MapPanel> = seen.into_iter().map(|(_, panel)| panel).collect();
    let (low, high) = bounds(panels.iter().flat_map(|p| &p.outline)).unwrap_or_default();
    RawView { title, panels, low, high }
}

/// A place inside a polygon, and how long and high a text there may be.
pub(crate) fn label_room(outline: &[DVec2]) -> (DVec2, DVec2) {
    let mut at = centroid(outline);
    if locate(outline, at) != Location::Inside {
        // The middle of the largest triangle.
        let area = |t: &[usize; 3]| {
            (outline[t[1]] - outline[t[0]]).perp_dot(outline[t[2]] - outline[t[0]]).abs()
        };
        let triangles = triangulate(outline);
        if let Some(t) = triangles.iter().max_by(|a, b| area(a).total_cmp(&area(b))) {
            at = (outline[t[0]] + outline[t[1]] + outline[t[2]]) / 3.0;
        }
    }
    let free = |direction: DVec2| reach(outline, at, direction).min(reach(outline, at, -direction));
    let length = 2.0 * free(DVec2::X);
    let height = 2.0 * free(DVec2::Y);
    let area = signed_area(outline).abs();
    (at, DVec2::new(length.min(2.0 * area.sqrt()), height))
}

/// How far it is from a point inside to the outline.
fn reach(outline: &[DVec2], from: DVec2, direction: DVec2) -> f64 {
    let n = outline.len();
    let hit = |i: usize| {
        let (a, b) = (outline[i] - from, outline[(i + 1) % n] - from);
        let (s, t) = (direction.perp_dot(a), direction.perp_dot(b));
        // Half-open, so that a corner counts once.
        ((s > 0.0) != (t > 0.0)).then(|| a.lerp(b, s / (s - t)).dot(direction)).filter(|&d| d > 0.0)
    };
    (0..n).filter_map(hit).fold(f64::INFINITY, f64::min)
}
