//! Group codes with their values, and the entities that they make up.

use std::borrow::Cow;

use glam::{DAffine2, DVec2, DVec3};

/// A group code with its value.
pub(super) type Pair<'a> = (i32, Cow<'a, str>);

/// A thing with its values.
#[derive(Debug, Clone, Default)]
pub(super) struct Entity<'a> {
    pub kind: &'a str,
    pub pairs: &'a [Pair<'a>],
    /// Vertices of an old polyline.
    pub vertices: Vec<Entity<'a>>,
}

impl Entity<'_> {
    pub fn text(&self, code: i32) -> Option<&str> {
        self.pairs.iter().find(|p| p.0 == code).map(|p| p.1.trim())
    }

    pub fn number(&self, code: i32) -> Option<f64> {
        self.text(code)?.parse().ok()
    }

    pub fn flags(&self, code: i32) -> i64 {
        self.number(code).unwrap_or(0.0) as i64
    }

    pub fn numbers(&self, code: i32) -> Vec<f64> {
        self.pairs.iter().filter(|p| p.0 == code).filter_map(|p| p.1.trim().parse().ok()).collect()
    }

    pub fn point(&self, code: i32) -> Option<DVec2> {
        Some(DVec2::new(self.number(code)?, self.number(code + 10).unwrap_or(0.0)))
    }

    /// The direction that its plane looks to; upwards unless said.
    pub fn normal(&self) -> DVec3 {
        let of = |code, default| self.number(code).unwrap_or(default);
        DVec3::new(of(210, 0.0), of(220, 0.0), of(230, 1.0)).normalize_or(DVec3::Z)
    }

    /// From its own coordinates to those of the world, seen from above (the "arbitrary axis" of the
    /// format). Some entities are in the world's from the start.
    pub fn to_world(&self) -> DAffine2 {
        let is_in_world = match self.kind {
            "LINE" | "POINT" | "ELLIPSE" | "SPLINE" | "MTEXT" => true,
            "POLYLINE" => self.flags(70) & 8 != 0,
            _ => false,
        };
        let normal = self.normal();
        if is_in_world || normal == DVec3::Z {
            return DAffine2::IDENTITY;
        }
        let is_steep = normal.truncate().abs().max_element() < 1.0 / 64.0;
        let x = if is_steep { DVec3::Y } else { DVec3::Z }.cross(normal).normalize_or(DVec3::X);
        let y = normal.cross(x);
        let lift = self.number(38).or_else(|| self.number(30)).unwrap_or(0.0);
        DAffine2::from_cols(x.truncate(), y.truncate(), (normal * lift).truncate())
    }
}
