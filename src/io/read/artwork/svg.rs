//! SVG: groups, transforms, nested views, `use`, presentation attributes and simple style sheets.

use std::collections::HashMap;

use glam::{DAffine2, DVec2};
use roxmltree::{Document, Node, ParsingOptions};

use super::budget::{Budget, Cost};
use super::curve::Flattener;
use super::decode::{check_xml, xml_text};
use super::svg_page::{Page, fit, view_box};
use super::svg_path::{
    PerInch, Subpaths, colour, has_infinite, length, point_list, subpaths, transform,
};
use super::svg_style::{Property, Rules};
use super::{ArtError, Collector, DEEPEST, Place};
use crate::lint::{Artwork, Operation};

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
const XLINK: &str = "http://www.w3.org/1999/xlink";

/// Attributes with numbers that a line is made of.
const NUMBERS: [&str; 20] = [
    "d",
    "points",
    "transform",
    "viewBox",
    "x",
    "y",
    "width",
    "height",
    "cx",
    "cy",
    "r",
    "rx",
    "ry",
    "x1",
    "y1",
    "x2",
    "y2",
    "dx",
    "dy",
    "style",
];

/// What children inherit.
#[derive(Clone)]
struct Context<'a> {
    transform: DAffine2,
    stroke: Option<[u8; 3]>,
    fill: Option<[u8; 3]>,
    color: Option<[u8; 3]>,
    is_visible: bool,
    layer: &'a str,
    operation: Option<Operation>,
    depth: usize,
    /// Width and height of the nearest view, for percentages.
    view: DVec2,
}

struct Reader<'a> {
    ids: HashMap<&'a str, Node<'a, 'a>>,
    rules: Rules,
    per_inch: PerInch,
    budget: &'a Budget,
    out: Collector<'a>,
}

pub(super) fn read(bytes: &[u8], budget: &Budget) -> Result<Artwork, ArtError> {
    let text = xml_text(bytes)?;
    check_xml(&text, budget)?;
    let limit = budget.left(Cost::Values) as u32;
    let options =
        ParsingOptions { allow_dtd: true, nodes_limit: limit / 4, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options).map_err(|e| match e {
        roxmltree::Error::NodesLimitReached => {
            budget.spend(Cost::Values, usize::MAX).err().unwrap_or(ArtError::TooDeep)
        }
        other => ArtError::Svg(other.to_string()),
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(ArtError::Svg(format!("the root is <{}>, not <svg>", root.tag_name().name())));
    }
    let page = Page::of(root);
    let mut out = Collector::new(budget);
    out.notes(page.note);
    out.is_by_boxes = text.get(..4000).unwrap_or(&text).to_ascii_lowercase().contains("boxes.py");
    let ids = document.descendants().filter_map(|n| n.attribute("id").map(|id| (id, n))).collect();
    let rules = Rules::of(&document);
    if rules.unread > 0 {
        out.notes(Some(format!(
            "{} selectors of style sheets are not read; colours may be others",
            rules.unread
        )));
    }
    let mut reader = Reader { ids, rules, per_inch: page.per_inch, budget, out };
    // y is turned over, so that the origin is at the lower left.
    let flip = DAffine2::from_cols_array(&[1.0, 0.0, 0.0, -1.0, 0.0, page.size.y]);
    let context = Context {
        transform: flip * page.to_mm,
        stroke: None,
        fill: Some([0; 3]),
        color: Some([0; 3]),
        is_visible: true,
        layer: "",
        operation: None,
        depth: 0,
        view: page.view,
    };
    if let Some(context) = reader.inherited(root, &context)? {
        reader.children(root, &context)?;
    }
    reader.out.finish(Some(page.size), page.unit)
}

impl<'a> Reader<'a> {
    fn children(&mut self, parent: Node<'a, 'a>, context: &Context<'a>) -> Result<(), ArtError> {
        parent.children().filter(Node::is_element).try_for_each(|node| self.element(node, context))
    }

    /// What holds for a node and its children; nothing where it is not shown.
    fn inherited(
        &mut self,
        node: Node<'a, 'a>,
        context: &Context<'a>,
    ) -> Result<Option<Context<'a>>, ArtError> {
        self.check_attributes(node)?;
        let mut here = context.clone();
        let declared = self.rules.declared(node);
        if declared.get(Property::Display) == Some("none") {
            return Ok(None);
        }
        if let Some(value) = declared.get(Property::Color) {
            here.color = colour(value, context.color);
        }
        if let Some(value) = declared.get(Property::Stroke) {
            here.stroke = colour(value, here.color);
        }
        if let Some(value) = declared.get(Property::Fill) {
            here.fill = colour(value, here.color);
        }
        if let Some(value) = declared.get(Property::Visibility) {
            here.is_visible = value == "visible";
        }
        for (property, name) in [(Property::ClipPath, "clip-path"), (Property::Mask, "mask")] {
            if declared.get(property).is_some_and(|value| value != "none") {
                self.out.unread(&format!("{name}; what it hides is judged"));
            }
        }
        if let Some(text) = node.attribute("transform") {
            here.transform *= transform(text);
        }
        if matches!(node.tag_name().name(), "g" | "svg" | "a") {
            let name = node.attribute((INKSCAPE, "label")).or_else(|| node.attribute("id"));
            if let Some(name) = name {
                // A group inside a layer that is known does not change the layer unless it says
                // one itself.
                let told = Operation::of_name(name);
                if told.is_some() || here.operation.is_none() {
                    here.layer = name;
                    here.operation = told;
                }
            }
        }
        Ok(Some(here))
    }

    /// Counts what an element costs to read, and refuses numbers beyond all numbers.
    fn check_attributes(&self, node: Node<'a, 'a>) -> Result<(), ArtError> {
        for attribute in node.attributes() {
            self.budget.spend(Cost::Steps, attribute.value().len() + 1)?;
            if NUMBERS.contains(&attribute.name()) && has_infinite(attribute.value()) {
                let id = node.attribute("id").map(|id| format!(" of `{id}`")).unwrap_or_default();
                let what = format!("`{}`{id}", attribute.name());
                return Err(ArtError::OutOfRange { what });
            }
        }
        Ok(())
    }

    fn element(&mut self, node: Node<'a, 'a>, context: &Context<'a>) -> Result<(), ArtError> {
        let Some(mut here) = self.inherited(node, context)? else { return Ok(()) };
        here.depth += 1;
        if here.depth > DEEPEST * 4 {
            return Err(ArtError::TooDeep);
        }
        match node.tag_name().name() {
            "g" | "a" | "switch" => self.children(node, &here)?,
            "svg" => {
                here.transform *= DAffine2::from_translation(self.corner(node, &here));
                self.viewport(node, &mut here);
                self.children(node, &here)?;
            }
            "use" => self.reuse(node, here)?,
            _ if !here.is_visible => {}
            "text" => self.text(node, &here)?,
            "image" | "foreignObject" => self.out.unread(node.tag_name().name()),
            _ => {
                let subpaths = self.shape(node, &here)?;
                self.lines(node, &here, subpaths)?;
            }
        }
        Ok(())
    }

    /// An attribute as a length in user units, in percent of a whole; 0 without it.
    fn side(&self, node: Node<'a, 'a>, name: &str, whole: f64) -> f64 {
        self.given(node, name, whole).unwrap_or(0.0)
    }

    fn given(&self, node: Node<'a, 'a>, name: &str, whole: f64) -> Option<f64> {
        node.attribute(name).and_then(|value| length(value, whole, self.per_inch)).map(|l| l.0)
    }

    fn pair(&self, node: Node<'a, 'a>, here: &Context<'a>, names: [&str; 2]) -> DVec2 {
        let [x, y] = names;
        DVec2::new(self.side(node, x, here.view.x), self.side(node, y, here.view.y))
    }

    fn corner(&self, node: Node<'a, 'a>, here: &Context<'a>) -> DVec2 {
        self.pair(node, here, ["x", "y"])
    }

    /// The view box of a nested view or symbol.
    fn viewport(&self, node: Node<'a, 'a>, here: &mut Context<'a>) {
        let side = |name: &str, whole: f64| self.given(node, name, whole).unwrap_or(whole);
        let port = DVec2::new(side("width", here.view.x), side("height", here.view.y));
        if let Some((low, view)) = node.attribute("viewBox").and_then(view_box) {
            here.transform *= fit(low, view, port, node.attribute("preserveAspectRatio"));
            here.view = view;
        }
    }

    fn reuse(&mut self, node: Node<'a, 'a>, mut here: Context<'a>) -> Result<(), ArtError> {
        self.budget.spend(Cost::Instances, 1)?;
        let link = node.attribute("href").or_else(|| node.attribute((XLINK, "href")));
        let target = link.and_then(|l| l.strip_prefix('#')).and_then(|id| self.ids.get(id));
        let Some(&target) = target else {
            self.out.unread("use of an element that is not in the file");
            return Ok(());
        };
        here.transform *= DAffine2::from_translation(self.corner(node, &here));
        // One use in another counts for more than one group in another.
        here.depth += 3;
        if target.tag_name().name() != "symbol" {
            return self.element(target, &here);
        }
        if here.depth > DEEPEST * 4 {
            return Err(ArtError::TooDeep);
        }
        let Some(mut inside) = self.inherited(target, &here)? else { return Ok(()) };
        self.viewport(target, &mut inside);
        self.children(target, &inside)
    }

    fn text(&mut self, node: Node<'a, 'a>, here: &Context<'a>) -> Result<(), ArtError> {
        let parts = node.descendants().filter(|n| n.is_text()).filter_map(|n| n.text());
        let text: String = parts.collect();
        self.budget.spend(Cost::Steps, text.len())?;
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        let Some(colour) = here.fill.or(here.stroke).filter(|_| !text.is_empty()) else {
            return Ok(());
        };
        let at = here.transform.transform_point2(self.corner(node, here));
        let place = Place { layer: here.layer, name: None, operation: here.operation, colour };
        self.out.text(&text, at, &place)
    }

    fn lines(
        &mut self,
        node: Node<'a, 'a>,
        here: &Context<'a>,
        subpaths: Subpaths,
    ) -> Result<(), ArtError> {
        let Some(colour) = here.stroke.or(here.fill) else { return Ok(()) };
        let operation = here
            .operation
            .or_else(|| node.attribute((INKSCAPE, "label")).and_then(Operation::of_name));
        let place = Place { layer: here.layer, name: node.attribute("id"), operation, colour };
        for (points, closed) in subpaths {
            let points = points.into_iter().map(|p| here.transform.transform_point2(p)).collect();
            self.out.path((points, closed), &place)?;
        }
        Ok(())
    }

    /// The outline of a basic shape, in its own units.
    fn shape(&mut self, node: Node<'a, 'a>, here: &Context<'a>) -> Result<Subpaths, ArtError> {
        let flattener = Flattener::of(&here.transform, self.budget);
        let at = |names: [&str; 2]| self.pair(node, here, names);
        Ok(match node.tag_name().name() {
            "path" => {
                let data = node.attribute("d").unwrap_or_default();
                let (subpaths, is_broken) = subpaths(data, &flattener)?;
                if is_broken {
                    self.out.unread("rest of a path after a mistake in its data");
                }
                subpaths
            }
            "line" => vec![(vec![at(["x1", "y1"]), at(["x2", "y2"])], false)],
            "polyline" => vec![(node.attribute("points").map_or_else(Vec::new, point_list), false)],
            "polygon" => vec![(node.attribute("points").map_or_else(Vec::new, point_list), true)],
            "circle" | "ellipse" => {
                let r = self.side(node, "r", here.view.length() / std::f64::consts::SQRT_2);
                let radii = if r > 0.0 { DVec2::splat(r) } else { at(["rx", "ry"]) };
                if radii.min_element() <= 0.0 {
                    return Ok(Vec::new());
                }
                let axes = [DVec2::X * radii.x, DVec2::Y * radii.y];
                vec![(flattener.ellipse(at(["cx", "cy"]), axes)?, true)]
            }
            "rect" => {
                let (rx, ry) =
                    (self.given(node, "rx", here.view.x), self.given(node, "ry", here.view.y));
                let radii = DVec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
                rectangle(at(["x", "y"]), at(["width", "height"]), radii, &flattener)?
            }
            _ => Vec::new(),
        })
    }
}

fn rectangle(
    low: DVec2,
    size: DVec2,
    radii: DVec2,
    flattener: &Flattener<'_>,
) -> Result<Subpaths, ArtError> {
    use std::f64::consts::{FRAC_PI_2, PI};
    if size.min_element() <= 0.0 {
        return Ok(Vec::new());
    }
    let radii = radii.min(size / 2.0);
    let corners = [low, low + DVec2::new(size.x, 0.0), low + size, low + DVec2::new(0.0, size.y)];
    if radii.min_element() <= 0.0 {
        return Ok(vec![(corners.to_vec(), true)]);
    }
    let inwards = [DVec2::ONE, DVec2::new(-1.0, 1.0), -DVec2::ONE, DVec2::new(1.0, -1.0)];
    let axes = [DVec2::X * radii.x, DVec2::Y * radii.y];
    let mut points = Vec::new();
    for (i, (corner, inwards)) in corners.into_iter().zip(inwards).enumerate() {
        let centre = corner + inwards * radii;
        let from = PI + i as f64 * FRAC_PI_2;
        points.push(centre + radii * DVec2::from_angle(from));
        flattener.arc(centre, axes, (from, FRAC_PI_2), &mut points)?;
    }
    Ok(vec![(points, true)])
}
