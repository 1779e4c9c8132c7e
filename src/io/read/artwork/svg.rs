//! SVG: groups, transforms, nested views, `use`, presentation attributes and simple style sheets.

use std::collections::BTreeMap;

use glam::{DAffine2, DVec2};
use roxmltree::{Document, Node, ParsingOptions};

use super::curve::Flattener;
use super::svg_path::{Subpaths, colour, length, point_list, subpaths, transform};
use super::{ArtError, Collector, DEEPEST, Place};
use crate::lint::{Artwork, Operation, UnitState};

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
const XLINK: &str = "http://www.w3.org/1999/xlink";

/// Millimetres in a user unit of 1/96 in.
const PIXEL: f64 = 25.4 / 96.0;

/// An attribute as a length in user units, in percent of a whole.
type Side<'a> = &'a dyn Fn(&str, f64) -> f64;

/// What children inherit.
#[derive(Clone)]
struct Context {
    transform: DAffine2,
    stroke: Option<[u8; 3]>,
    fill: Option<[u8; 3]>,
    layer: String,
    operation: Option<Operation>,
    depth: usize,
    /// Width and height of the nearest view, for percentages.
    view: DVec2,
}

/// Style rules by selector: a tag, a class with its dot, or an id with its hash.
type Rules = BTreeMap<String, Vec<(String, String)>>;

struct Reader<'a> {
    ids: BTreeMap<&'a str, Node<'a, 'a>>,
    rules: Rules,
    out: Collector,
}

pub(super) fn read(bytes: &[u8]) -> Result<Artwork, ArtError> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        ArtError::Svg(format!("byte {} is no UTF-8; save it as UTF-8", e.valid_up_to()))
    })?;
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let document =
        Document::parse_with_options(text, options).map_err(|e| ArtError::Svg(e.to_string()))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(ArtError::Svg(format!("the root is <{}>, not <svg>", root.tag_name().name())));
    }
    let ids = document.descendants().filter_map(|n| n.attribute("id").map(|id| (id, n))).collect();
    let mut reader = Reader { ids, rules: rules(&document), out: Collector::default() };
    let (size, view, unit) = page(root);
    // y is turned over, so that the origin is at the lower left.
    let flip = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, 0.0, size.y]);
    let context = Context {
        transform: flip * DAffine2::from_scale(DVec2::splat(PIXEL)) * view.0,
        stroke: None,
        fill: Some([0; 3]),
        layer: String::new(),
        operation: None,
        depth: 0,
        view: view.1,
    };
    let context = reader.style(root, &context).map(|c| c.0).unwrap_or(context);
    reader.children(root, &context)?;
    Ok(reader.out.finish(Some(size), unit))
}

/// The page in mm, the way from user units to pixels with the size of the view, and what the file
/// says about its unit.
fn page(root: Node<'_, '_>) -> (DVec2, (DAffine2, DVec2), UnitState) {
    let side =
        |name: &str| root.attribute(name).and_then(|v| length(v, f64::NAN)).filter(|l| l.0 > 0.0);
    let view = root
        .attribute("viewBox")
        .map(point_list)
        .filter(|p| p.len() == 2 && p[1].min_element() > 0.0);
    let (width, height) = (side("width"), side("height"));
    let own = view.as_ref().map_or(DVec2::new(300.0, 150.0), |v| v[1]);
    let size =
        DVec2::new(width.as_ref().map_or(own.x, |w| w.0), height.as_ref().map_or(own.y, |h| h.0));
    let is_said = |l: &Option<(f64, String)>| {
        l.as_ref().is_some_and(|l| !matches!(l.1.as_str(), "" | "px" | "em" | "ex"))
    };
    let mut unit = if is_said(&width) && is_said(&height) {
        UnitState::Known
    } else {
        UnitState::Missing("1/96 in for a user unit is assumed")
    };
    let Some(view) = view else {
        return (size * PIXEL, (DAffine2::IDENTITY, size), unit);
    };
    let stretch = size / view[1];
    if unit == UnitState::Known && (stretch.x - stretch.y).abs() > 1e-3 * stretch.max_element() {
        unit = UnitState::Contradictory(
            "width and height do not have the proportions of the viewBox; lengths are not true",
        );
    }
    (
        size * PIXEL,
        (fit(view[0], view[1], size, root.attribute("preserveAspectRatio")), view[1]),
        unit,
    )
}

/// A view box fitted into a viewport.
fn fit(low: DVec2, view: DVec2, port: DVec2, how: Option<&str>) -> DAffine2 {
    let how = how.unwrap_or_default();
    let stretch = port / view;
    let scale = match how {
        h if h.contains("none") => stretch,
        h if h.contains("slice") => DVec2::splat(stretch.max_element()),
        _ => DVec2::splat(stretch.min_element()),
    };
    let share = |min: &str, max: &str| {
        if how.contains(min) {
            0.0
        } else if how.contains(max) {
            1.0
        } else {
            0.5
        }
    };
    let rest = (port - view * scale) * DVec2::new(share("xMin", "xMax"), share("YMin", "YMax"));
    DAffine2::from_translation(rest)
        * DAffine2::from_scale(scale)
        * DAffine2::from_translation(-low)
}

/// The rules of all style sheets whose selectors are one tag, class or id.
fn rules(document: &Document<'_>) -> Rules {
    let mut rules = Rules::new();
    for sheet in document.descendants().filter(|n| n.tag_name().name() == "style") {
        let text: String = sheet.descendants().filter_map(|n| n.text()).collect();
        for block in text.split('}') {
            let Some((selectors, body)) = block.split_once('{') else { continue };
            for selector in selectors.split(',') {
                rules.entry(selector.trim().to_owned()).or_default().extend(declarations(body));
            }
        }
    }
    rules
}

fn declarations(text: &str) -> Vec<(String, String)> {
    let pair = |d: &str| {
        d.split_once(':')
            .map(|(k, v)| (k.trim().to_owned(), v.replace("!important", "").trim().to_owned()))
    };
    text.split(';').filter_map(pair).collect()
}

impl<'a> Reader<'a> {
    fn children(&mut self, parent: Node<'a, 'a>, context: &Context) -> Result<(), ArtError> {
        parent.children().filter(Node::is_element).try_for_each(|node| self.element(node, context))
    }

    /// What holds for a node and its children; nothing where it is not shown.
    fn style(&self, node: Node<'a, 'a>, context: &Context) -> Option<(Context, bool)> {
        let mut here = context.clone();
        let mut is_visible = true;
        let tag = node.tag_name().name();
        let mut declared: Vec<(String, String)> = Vec::new();
        for name in ["stroke", "fill", "display", "visibility", "opacity"] {
            declared.extend(node.attribute(name).map(|value| (name.to_owned(), value.to_owned())));
        }
        declared.extend(self.rules.get(tag).into_iter().flatten().cloned());
        for class in node.attribute("class").into_iter().flat_map(str::split_whitespace) {
            declared.extend(self.rules.get(&format!(".{class}")).into_iter().flatten().cloned());
        }
        if let Some(id) = node.attribute("id") {
            declared.extend(self.rules.get(&format!("#{id}")).into_iter().flatten().cloned());
        }
        declared.extend(node.attribute("style").into_iter().flat_map(declarations));
        for (name, value) in declared {
            match (name.as_str(), value.as_str()) {
                (_, "inherit") => {}
                ("stroke", value) => here.stroke = colour(value),
                ("fill", value) => here.fill = colour(value),
                ("display", "none") => return None,
                ("visibility", value) => is_visible = value == "visible",
                _ => {}
            }
        }
        if let Some(text) = node.attribute("transform") {
            here.transform *= transform(text);
        }
        if matches!(tag, "g" | "svg" | "a") {
            let name = node.attribute((INKSCAPE, "label")).or_else(|| node.attribute("id"));
            if let Some(name) = name {
                // A group inside a layer that is known does not change the layer unless it tells
                // one itself.
                let told = Operation::of_name(name);
                if told.is_some() || here.operation.is_none() {
                    here.layer = name.to_owned();
                    here.operation = told;
                }
            }
        }
        Some((here, is_visible))
    }

    fn element(&mut self, node: Node<'a, 'a>, context: &Context) -> Result<(), ArtError> {
        let Some((mut here, is_visible)) = self.style(node, context) else { return Ok(()) };
        here.depth += 1;
        if here.depth > DEEPEST * 4 {
            return Err(ArtError::TooDeep);
        }
        let side = |name: &str, whole: f64| {
            node.attribute(name).and_then(|v| length(v, whole)).map_or(0.0, |l| l.0)
        };
        let (w, h) = (here.view.x, here.view.y);
        match node.tag_name().name() {
            "g" | "a" | "switch" => self.children(node, &here)?,
            "svg" => {
                here.transform *=
                    DAffine2::from_translation(DVec2::new(side("x", w), side("y", h)));
                self.viewport(node, &mut here);
                self.children(node, &here)?;
            }
            "use" => self.reuse(node, here, DVec2::new(side("x", w), side("y", h)))?,
            "text" => {
                let text: String =
                    node.descendants().filter_map(|n| n.text()).collect::<Vec<_>>().concat();
                let at = here.transform.transform_point2(DVec2::new(side("x", w), side("y", h)));
                if is_visible && !text.trim().is_empty() {
                    self.out.text(text.split_whitespace().collect::<Vec<_>>().join(" "), at);
                }
            }
            "image" | "foreignObject" => self.out.unread(node.tag_name().name()),
            _ if !is_visible => {}
            _ => {
                let subpaths = shape(node, &here, &side);
                self.lines(node, &here, subpaths);
            }
        }
        Ok(())
    }

    /// The view box of a nested view or symbol.
    fn viewport(&self, node: Node<'_, '_>, here: &mut Context) {
        let side = |name: &str, whole: f64| {
            node.attribute(name).and_then(|v| length(v, whole)).map_or(whole, |l| l.0)
        };
        let port = DVec2::new(side("width", here.view.x), side("height", here.view.y));
        if let Some(view) = node
            .attribute("viewBox")
            .map(point_list)
            .filter(|v| v.len() == 2 && v[1].min_element() > 0.0)
        {
            here.transform *= fit(view[0], view[1], port, node.attribute("preserveAspectRatio"));
            here.view = view[1];
        }
    }

    fn reuse(
        &mut self,
        node: Node<'a, 'a>,
        mut here: Context,
        shift: DVec2,
    ) -> Result<(), ArtError> {
        let link = node
            .attribute("href")
            .or_else(|| node.attribute((XLINK, "href")))
            .and_then(|l| l.strip_prefix('#'));
        let Some(&target) = link.and_then(|id| self.ids.get(id)) else { return Ok(()) };
        here.transform *= DAffine2::from_translation(shift);
        // One use in another counts for more than one group in another.
        here.depth += 3;
        if here.depth > DEEPEST * 4 {
            return Err(ArtError::TooDeep);
        }
        if target.tag_name().name() == "symbol" {
            let Some((mut inside, _)) = self.style(target, &here) else { return Ok(()) };
            self.viewport(target, &mut inside);
            return self.children(target, &inside);
        }
        self.element(target, &here)
    }

    fn lines(&mut self, node: Node<'a, 'a>, here: &Context, subpaths: Subpaths) {
        let Some(colour) = here.stroke.or(here.fill) else { return };
        for (points, closed) in subpaths {
            let points = points.into_iter().map(|p| here.transform.transform_point2(p)).collect();
            let told = here
                .operation
                .or_else(|| node.attribute((INKSCAPE, "label")).and_then(Operation::of_name));
            let place =
                Place { layer: &here.layer, name: node.attribute("id"), operation: told, colour };
            self.out.path((points, closed), &place);
        }
    }
}

/// The outline of a basic shape, in its own units.
fn shape(node: Node<'_, '_>, here: &Context, side: Side<'_>) -> Subpaths {
    let flattener = Flattener::of(&here.transform);
    let (w, h) = (here.view.x, here.view.y);
    let diagonal = here.view.length() / std::f64::consts::SQRT_2;
    let at = |x: &str, y: &str| DVec2::new(side(x, w), side(y, h));
    match node.tag_name().name() {
        "path" => node.attribute("d").map_or_else(Vec::new, |d| subpaths(d, &flattener)),
        "line" => vec![(vec![at("x1", "y1"), at("x2", "y2")], false)],
        "polyline" => vec![(node.attribute("points").map_or_else(Vec::new, point_list), false)],
        "polygon" => vec![(node.attribute("points").map_or_else(Vec::new, point_list), true)],
        "circle" | "ellipse" => {
            let r = side("r", diagonal);
            let radii = if r > 0.0 { DVec2::splat(r) } else { at("rx", "ry") };
            if radii.min_element() <= 0.0 {
                return Vec::new();
            }
            let axes = [DVec2::X * radii.x, DVec2::Y * radii.y];
            vec![(flattener.ellipse(at("cx", "cy"), axes), true)]
        }
        "rect" => {
            rectangle(at("x", "y"), at("width", "height"), (node, side, here.view), &flattener)
        }
        _ => Vec::new(),
    }
}

fn rectangle(
    low: DVec2,
    size: DVec2,
    (node, side, view): (Node<'_, '_>, Side<'_>, DVec2),
    flattener: &Flattener,
) -> Subpaths {
    if size.min_element() <= 0.0 {
        return Vec::new();
    }
    let given = |name: &str, whole: f64| node.attribute(name).map(|_| side(name, whole));
    let (rx, ry) = (given("rx", view.x), given("ry", view.y));
    let radii = DVec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)).min(size / 2.0);
    let corners = [low, low + DVec2::new(size.x, 0.0), low + size, low + DVec2::new(0.0, size.y)];
    if radii.min_element() <= 0.0 {
        return vec![(corners.to_vec(), true)];
    }
    let mut points = Vec::new();
    for (i, corner) in corners.into_iter().enumerate() {
        let inwards = [DVec2::ONE, DVec2::new(-1.0, 1.0), -DVec2::ONE, DVec2::new(1.0, -1.0)][i];
        let centre = corner + inwards * radii;
        let from = std::f64::consts::PI + i as f64 * std::f64::consts::FRAC_PI_2;
        points.push(centre + radii * DVec2::from_angle(from));
        let axes = [DVec2::X * radii.x, DVec2::Y * radii.y];
        flattener.arc(centre, axes, (from, std::f64::consts::FRAC_PI_2), &mut points);
    }
    vec![(points, true)]
}
