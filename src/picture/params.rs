//! What a picture of a model should look like.

use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use glam::DVec3;
use serde::{Deserialize, Deserializer};

use super::PictureError;
use crate::code::codes;
use crate::units::parse_number;

/// How to draw a model. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, PartialEq, clap::Args, serde::Deserialize)]
pub struct RenderParams {
    /// Width of the picture in pixels, 16 to 8192.
    #[arg(long, default_value_t = default_width())]
    #[serde(default = "default_width")]
    pub width: u32,
    /// Height of the picture in pixels, 16 to 8192. Without it, three quarters of the width.
    #[arg(long)]
    #[serde(default)]
    pub height: Option<u32>,
    /// What the colours tell: faces (plain), planarity, valence, group or piece.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub colour: Colour,
    /// Where to look from: three-quarter, iso, front, back, left, right, top, bottom, or a
    /// direction x,y,z from the model to the eye; through looks into the largest hole, if any.
    #[arg(long, default_value_t, allow_hyphen_values = true)]
    #[serde(default)]
    pub view: View,
    /// The axis of the model that points up in the picture.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub up: UpAxis,
    /// Gentle perspective, or parallel as in an elevation.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub projection: Projection,
    /// How much nearer than for a whole view, 0.1 to 20: what is at the middle fills the picture.
    #[arg(long, default_value_t = default_zoom(), value_parser = parse_number)]
    #[serde(default = "default_zoom")]
    pub zoom: f64,
    /// Whether edges are drawn.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub edges: EdgeLines,
    /// Whose numbers are written, where they can be seen: of vertices, edges or faces.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub ids: Ids,
    /// How surfaces look: solid, x-ray, or smooth where faces meet at less than 35°.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub surface: Surface,
    /// Whether hollows lie in a soft shadow.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub shadow: Shadow,
    /// Several views on one picture, by their names: front,right,top,iso; instead of --view.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    #[serde(default)]
    pub views: Vec<View>,
}

fn default_zoom() -> f64 {
    1.0
}

fn default_width() -> u32 {
    1200
}

impl Default for RenderParams {
    fn default() -> Self {
        Self {
            width: default_width(),
            height: None,
            colour: Colour::default(),
            view: View::default(),
            up: UpAxis::default(),
            projection: Projection::default(),
            zoom: default_zoom(),
            edges: EdgeLines::default(),
            ids: Ids::default(),
            surface: Surface::default(),
            shadow: Shadow::default(),
            views: Vec::new(),
        }
    }
}

/// What the colours of a picture tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Colour {
    /// Plain material; what is seen from behind is blue-grey.
    #[default]
    Faces,
    /// Each face by the distance of its corners from their best plane, with a scale in mm.
    Planarity,
    /// Each vertex by its valence: 3 is green, less is violet, more is yellow to red.
    Valence,
    /// Each face by its group; faces without a group stay plain.
    Group,
    /// Each face by its piece: what marked seams bound, else what is connected. In a recipe that
    /// unfolds, the pieces on its sheets.
    Piece,
}

/// Whose numbers are written on a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ids {
    /// No numbers.
    #[default]
    None,
    /// Of vertices, beside them.
    Vertices,
    /// Of edges, at their middles.
    Edges,
    /// Of faces, inside them.
    Faces,
    /// Of the elements that are pointed out.
    Marked,
}

/// How surfaces look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Surface {
    /// What is behind is hidden.
    #[default]
    Solid,
    /// What is behind shows through, hidden edges are pale.
    XRay,
    /// Solid, shaded as if faces that meet at less than 35° were one bent surface.
    Smooth,
}

/// Whether hollows lie in a soft shadow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shadow {
    /// No shadow.
    #[default]
    Off,
    /// Where something near stands in front of the light, by the depths of the picture.
    Soft,
}

/// The axis of the model that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpAxis {
    /// z up: CAD, architecture, the models made here.
    #[default]
    Z,
    /// y up: many OBJ files from animation.
    Y,
}

/// How depth shortens.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Projection {
    /// Seen from about two and a half diagonals away.
    #[default]
    Perspective,
    /// Seen from infinitely far away.
    Parallel,
}

/// Whether edges are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeLines {
    /// Edges, outlines and rims.
    #[default]
    On,
    /// Faces only.
    Off,
}

/// Where to look from. The named views suppose that z is up and that the front looks along +y.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum View {
    /// From the front, somewhat from the right and from above; no two axes look alike.
    #[default]
    ThreeQuarter,
    /// From (1, −1, 1); with parallel projection the isometric view.
    Iso,
    /// The front.
    Front,
    /// The back.
    Back,
    /// The left side.
    Left,
    /// The right side.
    Right,
    /// From above; the front is at the bottom of the picture.
    Top,
    /// From below; the front is at the top of the picture.
    Bottom,
    /// Through the largest hole that can be looked through; three-quarter where there is none.
    Through,
    /// From this direction, in the model's own axes whatever axis is up.
    From(DVec3),
}

/// The named views and their words.
const VIEWS: [(&str, View); 9] = [
    ("three-quarter", View::ThreeQuarter),
    ("iso", View::Iso),
    ("front", View::Front),
    ("back", View::Back),
    ("left", View::Left),
    ("right", View::Right),
    ("top", View::Top),
    ("bottom", View::Bottom),
    ("through", View::Through),
];

/// A view that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is not a view; write three-quarter, iso, front, back, left, right, top, bottom, \
    through or a direction like 1,-2,0.5"
)]
pub struct ViewError {
    /// What was typed.
    pub text: String,
}

codes!(error struct ViewError = 831);

impl FromStr for View {
    type Err = ViewError;
    fn from_str(text: &str) -> Result<Self, ViewError> {
        let word = text.trim();
        let named = VIEWS.iter().find(|(name, _)| *name == word).map(|&(_, view)| view);
        named.or_else(|| direction(word)).ok_or_else(|| ViewError { text: text.to_owned() })
    }
}

fn direction(text: &str) -> Option<View> {
    let numbers: Vec<f64> = text.split(',').map(parse_number).collect::<Result<_, _>>().ok()?;
    let &[x, y, z] = numbers.as_slice() else { return None };
    let from = DVec3::new(x, y, z);
    (from != DVec3::ZERO).then_some(View::From(from))
}

impl fmt::Display for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self, VIEWS.iter().find(|(_, view)| view == self)) {
            (_, Some((name, _))) => f.write_str(name),
            (Self::From(d), None) => write!(f, "{},{},{}", d.x, d.y, d.z),
            (_, None) => unreachable!("every other view has a name"),
        }
    }
}

/// A view in a recipe: a word or text with three numbers, or an array of three numbers.
#[derive(Deserialize)]
#[serde(untagged)]
enum Typed {
    Text(String),
    Numbers([f64; 3]),
}

impl<'de> Deserialize<'de> for View {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Typed::deserialize(deserializer)? {
            Typed::Text(text) => text.parse().map_err(serde::de::Error::custom),
            Typed::Numbers(xyz) => Ok(Self::From(DVec3::from_array(xyz))),
        }
    }
}

impl RenderParams {
    /// Width and height in pixels, not yet checked.
    pub(super) fn pixels(&self) -> (u32, u32) {
        let three_quarters = (self.width / 4 * 3 + self.width % 4 * 3 / 4).max(super::MIN_PIXELS);
        (self.width, self.height.unwrap_or(three_quarters))
    }

    /// The direction from the model to the eye, of unit length, in the model's axes.
    ///
    /// # Errors
    /// [`PictureError::NoDirection`].
    pub fn eye(&self) -> Result<DVec3, PictureError> {
        self.axes().map(|[_, _, eye]| eye)
    }

    /// Unit vectors in the model's axes: to the right, up, and towards the eye.
    pub(super) fn axes(&self) -> Result<[DVec3; 3], PictureError> {
        let (direction, upright) = match self.view {
            View::From(d) => (d, None),
            // Which way is through is found before there are axes.
            View::ThreeQuarter | View::Through => (DVec3::new(0.52, -1.0, 0.62), None),
            View::Iso => (DVec3::new(1.0, -1.0, 1.0), None),
            View::Front => (-DVec3::Y, None),
            View::Back => (DVec3::Y, None),
            View::Left => (-DVec3::X, None),
            View::Right => (DVec3::X, None),
            View::Top => (DVec3::Z, Some(DVec3::Y)),
            View::Bottom => (-DVec3::Z, Some(-DVec3::Y)),
        };
        let up = if self.up == UpAxis::Z { DVec3::Z } else { DVec3::Y };
        // Named views are given with z up; the quarter turn about x takes z to y and the front (−y)
        // to z.
        let is_named = !matches!(self.view, View::From(_));
        let turn = |d: DVec3| {
            if is_named && self.up == UpAxis::Y { DVec3::new(d.x, d.z, -d.y) } else { d }
        };
        // Scaled first, so that neither tiny nor huge directions vanish or overflow when squared.
        let eye = (turn(direction) / direction.abs().max_element()).try_normalize();
        let eye = eye.ok_or(PictureError::NoDirection {
            x: direction.x,
            y: direction.y,
            z: direction.z,
        })?;
        let up = upright.map_or(up, turn);
        let right = up.cross(eye).try_normalize().filter(|_| up.cross(eye).length() > 1e-6);
        let right = right.unwrap_or(DVec3::X);
        let right = (right - eye * right.dot(eye)).normalize();
        Ok([right, eye.cross(right), eye])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        params: RenderParams,
    }

    fn typed(args: &[&str]) -> Result<RenderParams, clap::Error> {
        use clap::Parser;
        Line::try_parse_from([&["render"], args].concat()).map(|line| line.params)
    }

    #[test]
    fn the_three_doors_agree_on_the_defaults() {
        let recipe: RenderParams = toml::from_str("").expect("all fields have defaults");
        assert_eq!(recipe, RenderParams::default());
        assert_eq!(typed(&[]).expect("all flags have defaults"), RenderParams::default());
        assert_eq!(RenderParams::default().pixels(), (1200, 900));
    }

    #[test]
    fn flags_and_keys_read_the_same_words() {
        let recipe: RenderParams = toml::from_str(
            "width = 800\nheight = 600\ncolour = \"planarity\"\nview = [1, -2, \
            0.5]\nup = \"y\"\nprojection = \"parallel\"\nedges = \"off\"",
        )
        .expect("a recipe");
        let line = typed(&[
            "--width=800",
            "--height=600",
            "--colour=planarity",
            "--view",
            "1,-2,1/2",
            "--up=y",
            "--projection=parallel",
            "--edges=off",
        ]);
        assert_eq!(line.expect("flags"), recipe);
        assert!(typed(&["--view", "-1,0,0"]).is_ok());
        assert!(typed(&["--view", "0,0,0"]).is_err());
        assert!(typed(&["--view", "sideways"]).is_err());
    }

    #[test]
    fn views_are_shown_as_they_are_typed() {
        for text in VIEWS.map(|(name, _)| name).into_iter().chain(["1,-2,0.5"]) {
            assert_eq!(text.parse::<View>().expect("a view").to_string(), text);
        }
    }

    #[test]
    fn axes_are_right_handed_for_every_view() {
        for view in VIEWS
            .map(|(_, view)| view)
            .into_iter()
            .chain([View::From(DVec3::Z), View::From(DVec3::X * 1e-200)])
        {
            for up in [UpAxis::Z, UpAxis::Y] {
                let params = RenderParams { view, up, ..RenderParams::default() };
                let [x, y, z] = params.axes().expect("a direction");
                assert!((x.cross(y) - z).length() < 1e-12, "{view} {up:?}");
                assert!((z.length() - 1.0).abs() < 1e-12, "{view} {up:?}");
            }
        }
        let front = RenderParams { view: View::Front, ..RenderParams::default() };
        assert_eq!(front.axes().expect("a view"), [DVec3::X, DVec3::Z, -DVec3::Y]);
        let front = RenderParams { up: UpAxis::Y, ..front };
        assert_eq!(front.axes().expect("a view"), [DVec3::X, DVec3::Y, DVec3::Z]);
        let none = RenderParams { view: View::From(DVec3::ZERO), ..RenderParams::default() };
        assert!(matches!(none.axes(), Err(PictureError::NoDirection { .. })));
    }
}
