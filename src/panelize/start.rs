//! Where the corners start: where the tangent planes of the panels around them meet.
//!
//! Over z = (x, y) · II · (x, y) / 2 the tangent planes at three sites meet above the circumcentre
//! of the sites in the metric II (Pottmann, Liu 2007, "Discrete surfaces in isotropic geometry").
//! Where II is nearly singular that point runs away; Tikhonov's term holds it near where it was.

use glam::{DMat2, DVec2, DVec3};

use super::curvature::Quadric;
use super::regions::{Kind, Panels};
use super::surface::Pins;

/// How strongly corners are held, and how far they may go, in panel sizes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hold {
    pub strength: f64,
    pub reach: f64,
}

/// For a first start.
const FIRST: Hold = Hold { strength: 0.05, reach: 0.45 };
/// For the corners of an edge that was turned.
pub(super) const TURNED: Hold = Hold { strength: 0.1, reach: 0.3 };

/// Moves every inner corner to where the tangent planes at the sites of its panels meet; those of
/// panels of given vertices stay, since the middle of such a panel may be far.
pub(super) fn start(panels: &mut Panels, quadrics: &[Quadric], pins: &Pins) {
    let is_given = |&f: &usize| pins.areas.get(f).is_some_and(Option::is_some);
    for (v, fan) in panels.fans().iter().enumerate() {
        if fan.iter().any(is_given) {
            continue;
        }
        if let (Kind::Inner, &[a, b, c]) = (panels.kinds[v], &fan[..]) {
            let sites = [a, b, c].map(|f| quadrics[panels.sites[f]].origin);
            let quadric = &quadrics[panels.hints[v]];
            panels.points[v] = meeting_point(quadric, panels.points[v], sites, FIRST);
        }
    }
}

/// Where the tangent planes at three sites of a quadric meet, near a place.
pub(super) fn meeting_point(
    quadric: &Quadric,
    near: DVec3,
    sites: [DVec3; 3],
    hold: Hold,
) -> DVec3 {
    let [a, b, c] = sites.map(|site| quadric.flatten(site));
    let here = quadric.flatten(near);
    let bend = |x: DVec2| quadric.bend * x;
    let rows = [bend(b - a), bend(c - a)];
    let right = DVec2::new(b.dot(bend(b)) - a.dot(bend(a)), c.dot(bend(c)) - a.dot(bend(a))) / 2.0;
    let scale = (quadric.bend.x_axis.length() + quadric.bend.y_axis.length()).max(1e-9);
    let [r, s] = rows.map(|row| row / scale);
    let lack = right / scale - DVec2::new(r.dot(here), s.dot(here));
    // (AᵀA + strength) d = Aᵀ lack
    let matrix = DMat2::from_cols(r * r.x + s * s.x, r * r.y + s * s.y)
        + DMat2::from_diagonal(DVec2::splat(hold.strength));
    let way = matrix.inverse() * (r * lack.x + s * lack.y);
    quadric.lift(here + way.clamp_length_max(hold.reach))
}
