//! Inks and light.

use glam::{DVec3, Vec3};

/// Light as red, green and blue in 0..=1, in a scale where light adds up: the square of what a
/// screen is told. The square instead of the sRGB curve, because square roots are the same on every
/// machine.
pub(super) type Light = Vec3;

/// What a screen shows for `[red, green, blue]`.
pub(super) fn ink([r, g, b]: [u8; 3]) -> Light {
    let shown = Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0;
    shown * shown
}

/// The numbers for a screen.
pub(super) fn shown(light: Light) -> [u8; 3] {
    let level = |x: f32| (x.clamp(0.0, 1.0).sqrt() * 255.0 + 0.5) as u8;
    [level(light.x), level(light.y), level(light.z)]
}

pub(super) const PAPER: [u8; 3] = [251, 250, 248];
pub(super) const LINE: [u8; 3] = [40, 38, 36];
pub(super) const RIM: [u8; 3] = [196, 74, 28];
pub(super) const FRONT: [u8; 3] = [234, 225, 211];
pub(super) const BACK: [u8; 3] = [142, 163, 184];

/// What is pointed out, and faces that are.
pub(super) const MARK: [u8; 3] = [206, 32, 44];
pub(super) const MARKED: [u8; 3] = [236, 130, 92];

/// Slicing planes.
pub(super) const PLANE: [u8; 3] = [96, 150, 206];
pub(super) const SECTION: [u8; 3] = [84, 134, 200];
pub(super) const PLANE_LINE: [u8; 3] = [52, 104, 164];

/// Pale, so that dots stand out.
pub(super) const PALE: [u8; 3] = [244, 241, 236];

/// Colours of face groups, taken in turn: muted, and told apart by people who see few colours.
pub(super) const GROUPS: [[u8; 3]; 10] = [
    [136, 170, 206],
    [233, 178, 112],
    [150, 196, 150],
    [222, 140, 130],
    [178, 160, 208],
    [196, 168, 140],
    [232, 176, 204],
    [176, 184, 120],
    [140, 204, 206],
    [224, 210, 120],
];

/// The colour of a share in 0..=1, from calm blue over cream to alarming red.
pub(super) fn scale_colour(share: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 6] = [
        [96.0, 140.0, 190.0],
        [160.0, 200.0, 214.0],
        [240.0, 236.0, 206.0],
        [246.0, 196.0, 116.0],
        [226.0, 116.0, 70.0],
        [164.0, 36.0, 44.0],
    ];
    let along = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let i = (along as usize).min(STOPS.len() - 2);
    let between = along - i as f64;
    std::array::from_fn(|c| (STOPS[i][c] + (STOPS[i + 1][c] - STOPS[i][c]) * between + 0.5) as u8)
}

/// The colour of a vertex by its valence.
pub(super) fn valence_colour(valence: usize) -> [u8; 3] {
    match valence {
        0..=2 => [126, 87, 168],
        3 => [52, 142, 110],
        4 => [240, 180, 40],
        5 => [226, 112, 40],
        _ => [178, 30, 44],
    }
}

/// How much the light of the studio models a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Modelling {
    /// Material: full light and shadow.
    Full,
    /// Colours that tell something: soft enough to be compared with a legend.
    Soft,
}

/// A surface of colour `base` in the light of the studio: a key light from the upper left, a weak
/// fill from the right, and sky. `normal` has unit length, x right, y up, z to the eye, and looks
/// to the eye.
pub(super) fn lit(base: [u8; 3], normal: DVec3, modelling: Modelling) -> Light {
    let key = DVec3::new(-0.50, 0.60, 0.62).dot(normal).max(0.0);
    let fill = DVec3::new(0.80, 0.10, 0.59).dot(normal).max(0.0);
    let sky = 0.5 + 0.5 * normal.y;
    let full = 0.52 + 0.43 * key + 0.09 * fill + 0.12 * sky;
    let brightness = match modelling {
        Modelling::Full => full.min(1.03),
        Modelling::Soft => 0.66 + 0.34 * full.min(1.0),
    } as f32;
    // Shadows are a little cooler than lights, as under a sky.
    let cool = Vec3::new(-0.06, 0.0, 0.08) * (1.0 - brightness).max(0.0);
    (ink(base) * brightness * brightness * (Vec3::ONE + cool)).min(Vec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screens_show_what_was_meant() {
        for colour in [PAPER, LINE, RIM, FRONT, BACK, PALE, [0, 1, 255]] {
            assert_eq!(shown(ink(colour)), colour);
        }
        assert_eq!(scale_colour(0.0), [96, 140, 190]);
        assert_eq!(scale_colour(1.0), [164, 36, 44]);
    }

    #[test]
    fn the_three_sides_of_a_box_differ_in_every_light() {
        let [top, front, right] = [
            DVec3::new(0.0, 0.875, 0.484),
            DVec3::new(-0.461, -0.427, 0.778),
            DVec3::new(0.887, -0.222, 0.404),
        ];
        for modelling in [Modelling::Full, Modelling::Soft] {
            let [top, front, right] =
                [top, front, right].map(|n| i32::from(shown(lit(FRONT, n, modelling))[1]));
            assert!(top > front + 8 && front > right + 4, "{top} {front} {right}");
        }
    }
}
