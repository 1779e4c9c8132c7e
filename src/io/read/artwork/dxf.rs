//! DXF as text or binary, any version: header, layers, blocks, entities of the model space.

use std::borrow::Cow;
use std::collections::HashMap;

use glam::{DAffine2, DVec2};

use super::budget::{Budget, Cost};
use super::dxf_binary;
use super::dxf_entity::{Outline, outline};
use super::dxf_value::{Entity, Pair};
use super::{ArtError, Collector, DEEPEST, Place};
use crate::lint::{Artwork, Operation, UnitState};

#[derive(Default)]
struct Block<'a> {
    base: DVec2,
    entities: Vec<Entity<'a>>,
}

/// How the entities of a layer are drawn.
#[derive(Debug, Clone, Copy)]
struct Layer {
    colour: i64,
    /// Why they are not, if so; frozen layers hide what is put on them, too.
    hidden: Option<&'static str>,
    /// Whether they are on paper, too; what is not is a note.
    is_plotted: bool,
}

const FROZEN: &str = "entity on a layer that is frozen";
const OFF: &str = "entity on a layer that is off";
const NOT_PLOTTED: &str = "entity on a layer that is not plotted";

impl Layer {
    fn of(entity: &Entity<'_>) -> Self {
        let colour = entity.flags(62);
        let hidden = if entity.flags(70) & 1 != 0 {
            Some(FROZEN)
        } else if colour < 0 {
            Some(OFF)
        } else {
            None
        };
        let is_plotted = entity.number(290) != Some(0.0);
        Self { colour: colour.abs().max(1), hidden, is_plotted }
    }
}

/// Names of layers and blocks know no upper and lower case.
fn folded(name: &str) -> String {
    name.trim().to_uppercase()
}

#[derive(Default)]
struct Drawing<'a> {
    header: HashMap<&'a str, &'a str>,
    layers: HashMap<String, Layer>,
    blocks: HashMap<String, Block<'a>>,
    entities: Vec<Entity<'a>>,
}

pub(super) fn read(bytes: &[u8], budget: &Budget) -> Result<Artwork, ArtError> {
    let text;
    let pairs = match dxf_binary::pairs(bytes, budget)? {
        Some(pairs) => pairs,
        None => {
            // Names in old code pages do not matter here.
            text = super::decode::utf16(bytes)
                .map_or_else(|| String::from_utf8_lossy(bytes), Cow::Owned);
            text_pairs(&text, budget)?
        }
    };
    let drawing = Drawing::of(&pairs);
    let (factor, unit) = unit(&drawing);
    let mut insertion = Insertion { out: Collector::new(budget), budget, drawing: &drawing };
    let place = Placement {
        transform: DAffine2::from_scale(DVec2::splat(factor)),
        layer: None,
        colour: 7,
        depth: 0,
    };
    for entity in &drawing.entities {
        insertion.add(entity, &place)?;
    }
    insertion.out.finish(None, unit)
}

/// Group codes and values up to the end of the file; what comes after is no part of it.
fn text_pairs<'a>(text: &'a str, budget: &Budget) -> Result<Vec<Pair<'a>>, ArtError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.split(if text.contains('\n') { '\n' } else { '\r' }).enumerate();
    let mut pairs: Vec<Pair<'a>> = Vec::new();
    while let Some((i, code)) = lines.next() {
        let fault = "here a group code, a whole number, should stand; export the drawing again";
        let is_end = code.trim().is_empty() && lines.clone().all(|(_, l)| l.trim().is_empty());
        if is_end {
            break;
        }
        let code = code.trim().parse().map_err(|_| ArtError::Dxf { line: i + 1, fault })?;
        let fault = "the file breaks off after a group code; export the drawing again";
        let (_, value) = lines.next().ok_or(ArtError::Dxf { line: i + 1, fault })?;
        if code == 0 && value.trim() == "EOF" {
            return Ok(pairs);
        }
        budget.spend(Cost::Values, 1)?;
        pairs.push((code, Cow::Borrowed(value.trim_end_matches('\r'))));
    }
    let fault = "the file breaks off before its EOF; export the drawing again";
    Err(ArtError::Dxf { line: 2 * pairs.len(), fault })
}

impl<'a> Drawing<'a> {
    fn of(pairs: &'a [Pair<'a>]) -> Self {
        let mut drawing = Self::default();
        let mut section = "";
        let mut open: Option<(String, Block<'a>)> = None;
        let mut i = 0;
        while i < pairs.len() {
            let (code, kind) = (pairs[i].0, pairs[i].1.trim());
            let end = (i + 1..pairs.len()).find(|&k| pairs[k].0 == 0).unwrap_or(pairs.len());
            let entity = Entity { kind, pairs: &pairs[i + 1..end], vertices: Vec::new() };
            i = end;
            match (section, kind) {
                _ if code != 0 => {}
                (_, "SECTION") => {
                    section = entity.pairs.first().map_or("", |p| p.1.trim());
                    if section == "HEADER" {
                        drawing.read_header(entity.pairs);
                    }
                }
                (_, "ENDSEC") => section = "",
                ("TABLES", "LAYER") => {
                    let name = folded(entity.text(2).unwrap_or_default());
                    drawing.layers.insert(name, Layer::of(&entity));
                }
                ("BLOCKS", "BLOCK") => {
                    let name = folded(entity.text(2).unwrap_or("?"));
                    let base = entity.point(10).unwrap_or_default();
                    open = Some((name, Block { base, entities: Vec::new() }));
                }
                ("BLOCKS", "ENDBLK") => drawing.blocks.extend(open.take()),
                ("BLOCKS", _) => {
                    if let Some((_, block)) = &mut open {
                        append(&mut block.entities, entity);
                    }
                }
                ("ENTITIES", _) => append(&mut drawing.entities, entity),
                _ => {}
            }
        }
        drawing
    }

    /// The first value of every variable.
    fn read_header(&mut self, pairs: &'a [Pair<'a>]) {
        let mut name = "";
        for (code, value) in pairs {
            if *code == 9 {
                name = value.trim();
            } else {
                self.header.entry(name).or_insert_with(|| value.trim());
            }
        }
    }
}

/// Vertices go to the polyline before them.
fn append<'a>(entities: &mut Vec<Entity<'a>>, entity: Entity<'a>) {
    match (entity.kind, entities.last_mut()) {
        ("VERTEX", Some(last)) if last.kind == "POLYLINE" => last.vertices.push(entity),
        ("SEQEND", _) => {}
        _ => entities.push(entity),
    }
}

fn unit(drawing: &Drawing<'_>) -> (f64, UnitState) {
    let of = |name: &str| drawing.header.get(name).and_then(|v| v.parse::<i64>().ok());
    let metric = of("$MEASUREMENT");
    let contradiction = "$INSUNITS says a metric unit and $MEASUREMENT says inches";
    let state = |is_metric: bool| match metric {
        Some(0) if is_metric => UnitState::Contradictory(contradiction),
        _ => UnitState::Known,
    };
    let rows: [(i64, f64, bool); 12] = [
        (1, 25.4, false),
        (2, 304.8, false),
        (4, 1.0, true),
        (5, 10.0, true),
        (6, 1000.0, true),
        (7, 1e6, true),
        (8, 25.4e-6, false),
        (9, 0.0254, false),
        (10, 914.4, false),
        (11, 1e-7, true),
        (13, 1e-3, true),
        (14, 100.0, true),
    ];
    match of("$INSUNITS").and_then(|u| rows.iter().find(|r| r.0 == u)) {
        Some(&(_, factor, is_metric)) => (factor, state(is_metric)),
        None => (1.0, UnitState::Missing("millimetres are assumed")),
    }
}

/// Where entities are put, and what they take from there.
#[derive(Clone, Copy)]
struct Placement<'a> {
    transform: DAffine2,
    layer: Option<&'a str>,
    colour: i64,
    depth: usize,
}

/// Puts entities and blocks in their places.
struct Insertion<'a> {
    out: Collector<'a>,
    budget: &'a Budget,
    drawing: &'a Drawing<'a>,
}

impl<'a> Insertion<'a> {
    fn add(&mut self, entity: &'a Entity<'a>, place: &Placement<'a>) -> Result<(), ArtError> {
        if place.depth > DEEPEST {
            return Err(ArtError::TooDeep);
        }
        self.budget.spend(Cost::Steps, entity.pairs.len() + 1)?;
        // Paper space holds frames and views, not the drawing.
        if entity.flags(67) == 1 || entity.flags(60) == 1 {
            return Ok(());
        }
        let own = entity.text(8).unwrap_or("0");
        let layer = place.layer.filter(|_| own == "0").unwrap_or(own);
        let known = self.drawing.layers.get(&folded(layer)).copied();
        let known = known.unwrap_or(Layer { colour: 7, hidden: None, is_plotted: true });
        // What is put on a layer that is only switched off may lie on others.
        let is_hidden = |why| entity.kind != "INSERT" || why == FROZEN;
        if let Some(why) = known.hidden.filter(|why| is_hidden(*why)) {
            self.out.unread(why);
            return Ok(());
        }
        let colour = match entity.number(62).map(|c| c as i64) {
            None | Some(256) => known.colour,
            Some(0) => place.colour,
            Some(own) => own,
        };
        let transform = place.transform * entity.to_world();
        let here = Placement { transform, layer: Some(layer), colour, ..*place };
        match entity.kind {
            "INSERT" => self.insert(entity, &here),
            "ATTDEF" | "VIEWPORT" => Ok(()),
            kind => {
                let operation = self.operation(layer, known);
                let colour = index_colour(here.colour);
                let put = Place { layer, name: None, operation, colour };
                if matches!(kind, "TEXT" | "MTEXT" | "ATTRIB") {
                    self.text(entity, &put, &here)
                } else {
                    self.line(entity, &put, &here)
                }
            }
        }
    }

    /// What is done on a layer, as far as it says.
    fn operation(&mut self, layer: &str, known: Layer) -> Option<Operation> {
        let told = Operation::of_name(layer);
        if known.is_plotted || told == Some(Operation::Info) {
            return told;
        }
        self.out.unread(NOT_PLOTTED);
        Some(Operation::Info)
    }

    fn text(
        &mut self,
        entity: &Entity<'_>,
        put: &Place<'_>,
        here: &Placement<'_>,
    ) -> Result<(), ArtError> {
        // Long texts come in pieces, the last one under code 1.
        let pieces = entity.pairs.iter().filter(|p| matches!(p.0, 1 | 3));
        let text: String = pieces.map(|p| p.1.trim()).collect();
        let at = here.transform.transform_point2(entity.point(10).unwrap_or_default());
        self.out.text(&text, at, put)
    }

    fn line(
        &mut self,
        entity: &Entity<'_>,
        put: &Place<'_>,
        here: &Placement<'_>,
    ) -> Result<(), ArtError> {
        let Some(Outline { points, closed, is_flat, is_exact }) =
            outline(entity, &here.transform, self.budget)?
        else {
            self.out.unread(entity.kind);
            return Ok(());
        };
        let points: Vec<DVec2> =
            points.into_iter().map(|p| here.transform.transform_point2(p)).collect();
        let first = points.first().copied();
        self.out.path((points, closed), put)?;
        if !is_exact {
            self.out.unread("spline through points, taken as straight lines between them");
        }
        if let Some(at) = first.filter(|_| !is_flat) {
            self.out.not_flat(at);
        }
        Ok(())
    }

    fn insert(&mut self, entity: &'a Entity<'a>, here: &Placement<'a>) -> Result<(), ArtError> {
        let name = entity.text(2).unwrap_or_default();
        let drawing = self.drawing;
        let Some(block) = drawing.blocks.get(&folded(name)) else {
            self.out.unread(&format!("INSERT of block `{name}`, which is not in the file"));
            return Ok(());
        };
        let of = |code, default| entity.number(code).unwrap_or(default);
        let scale = DVec2::new(of(41, 1.0), of(42, 1.0));
        let turn = DAffine2::from_angle(of(50, 0.0).to_radians());
        let at = DAffine2::from_translation(entity.point(10).unwrap_or_default());
        let step = DVec2::new(of(44, 0.0), of(45, 0.0));
        let count = |code| of(code, 1.0).max(1.0) as usize;
        let (columns, rows) = (count(70), count(71));
        self.budget.expect(Cost::Instances, columns.saturating_mul(rows))?;
        for row in 0..rows {
            for column in 0..columns {
                self.budget.spend(Cost::Instances, 1)?;
                let shift = step * DVec2::new(column as f64, row as f64);
                let put = at
                    * turn
                    * DAffine2::from_translation(shift)
                    * DAffine2::from_scale(scale)
                    * DAffine2::from_translation(-block.base);
                let transform = here.transform * put;
                let inside = Placement { transform, depth: here.depth + 1, ..*here };
                for inner in &block.entities {
                    self.add(inner, &inside)?;
                }
            }
        }
        Ok(())
    }
}

/// The colours of the index that mean something to laser programs.
fn index_colour(index: i64) -> [u8; 3] {
    match index {
        1 => [255, 0, 0],
        2 => [255, 255, 0],
        3 => [0, 255, 0],
        4 => [0, 255, 255],
        5 => [0, 0, 255],
        6 => [255, 0, 255],
        7 | 250 => [0, 0, 0],
        _ => [128, 64, 64],
    }
}
