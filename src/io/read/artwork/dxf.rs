//! DXF as text, any version: header, layers, blocks, entities of the model space.

use std::collections::BTreeMap;

use glam::{DAffine2, DVec2};

use super::dxf_entity::outline;
use super::{ArtError, Collector, DEEPEST, Place};
use crate::lint::{Artwork, Operation, UnitState};

/// Group codes with their values.
pub(super) type Pairs = Vec<(i32, String)>;

/// A thing with its values.
#[derive(Debug, Clone, Default)]
pub(super) struct Entity {
    pub kind: String,
    pub pairs: Pairs,
    /// Vertices of an old polyline.
    pub vertices: Vec<Entity>,
}

impl Entity {
    pub fn text(&self, code: i32) -> Option<&str> {
        self.pairs.iter().find(|p| p.0 == code).map(|p| p.1.as_str())
    }

    pub fn number(&self, code: i32) -> Option<f64> {
        self.text(code)?.trim().parse().ok()
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
}

#[derive(Default)]
struct Block {
    base: DVec2,
    entities: Vec<Entity>,
}

#[derive(Default)]
struct Drawing {
    header: BTreeMap<String, String>,
    /// Layers with their colour numbers; negative means switched off.
    layers: BTreeMap<String, i64>,
    blocks: BTreeMap<String, Block>,
    entities: Vec<Entity>,
}

pub(super) fn read(bytes: &[u8]) -> Result<Artwork, ArtError> {
    let drawing = parse(&pairs(bytes)?);
    let (factor, unit) = unit(&drawing);
    let mut out = Collector::default();
    let scale = DAffine2::from_scale(DVec2::splat(factor));
    let inherited = Inherited { layer: None, colour: 7 };
    for entity in &drawing.entities {
        add(&mut out, &drawing, entity, (&scale, &inherited), 0)?;
    }
    Ok(out.finish(None, unit))
}

fn pairs(bytes: &[u8]) -> Result<Pairs, ArtError> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err(ArtError::Dxf {
            line: 1,
            fault: "this is binary DXF; save it as text (ASCII) DXF",
        });
    }
    // Names in old code pages do not matter here.
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.lines().enumerate();
    let mut pairs = Pairs::new();
    while let Some((i, code)) = lines.next() {
        if code.trim().is_empty() && pairs.last().is_some_and(|p| p.1.trim() == "EOF") {
            break;
        }
        let fault = "here a group code, a whole number, should stand; export the drawing again";
        let code = code.trim().parse().map_err(|_| ArtError::Dxf { line: i + 1, fault })?;
        let fault = "the file breaks off after a group code; export the drawing again";
        let (_, value) = lines.next().ok_or(ArtError::Dxf { line: i + 1, fault })?;
        pairs.push((code, value.trim_end_matches('\r').to_owned()));
    }
    if pairs.last().is_none_or(|p| p.1.trim() != "EOF") {
        let fault = "the file breaks off before its EOF; export the drawing again";
        return Err(ArtError::Dxf { line: 2 * pairs.len(), fault });
    }
    Ok(pairs)
}

fn parse(pairs: &Pairs) -> Drawing {
    let mut drawing = Drawing::default();
    let mut section = String::new();
    let mut i = 0;
    while i < pairs.len() {
        let (code, value) = (pairs[i].0, pairs[i].1.trim());
        if code == 0 && value == "SECTION" {
            section = pairs.get(i + 1).map(|p| p.1.trim().to_owned()).unwrap_or_default();
            i += 2;
            if section == "HEADER" {
                i = header(&mut drawing, pairs, i);
            }
            continue;
        }
        if code != 0 {
            i += 1;
            continue;
        }
        let end = (i + 1..pairs.len()).find(|&k| pairs[k].0 == 0).unwrap_or(pairs.len());
        let entity = Entity {
            kind: value.to_owned(),
            pairs: pairs[i + 1..end].to_vec(),
            vertices: Vec::new(),
        };
        i = end;
        match (section.as_str(), entity.kind.as_str()) {
            (_, "ENDSEC") => section.clear(),
            ("TABLES", "LAYER") => {
                let frozen = entity.flags(70) & 1 != 0;
                let colour = entity.flags(62);
                let colour = if frozen { -colour.abs().max(1) } else { colour };
                drawing.layers.insert(entity.text(2).unwrap_or_default().to_owned(), colour);
            }
            ("BLOCKS", _) => in_blocks(&mut drawing, entity, &mut Vec::new()),
            ("ENTITIES", _) => append(&mut drawing.entities, entity),
            _ => {}
        }
    }
    drawing
}

fn header(drawing: &mut Drawing, pairs: &Pairs, mut i: usize) -> usize {
    let mut name = String::new();
    while i < pairs.len() && pairs[i].0 != 0 {
        if pairs[i].0 == 9 {
            name = pairs[i].1.trim().to_owned();
        } else {
            drawing.header.entry(name.clone()).or_insert_with(|| pairs[i].1.trim().to_owned());
        }
        i += 1;
    }
    i
}

/// Blocks come one after the other; the one that is open is kept under the empty name.
fn in_blocks(drawing: &mut Drawing, entity: Entity, _: &mut Vec<String>) {
    const OPEN: &str = "";
    match entity.kind.as_str() {
        "BLOCK" => {
            let base = entity.point(10).unwrap_or_default();
            let name = entity.text(2).unwrap_or("?").to_owned();
            let mut block = Block { base, entities: Vec::new() };
            block.entities.push(Entity { kind: name, ..Entity::default() });
            drawing.blocks.insert(OPEN.to_owned(), block);
        }
        "ENDBLK" => {
            if let Some(mut block) = drawing.blocks.remove(OPEN) {
                let name = block.entities.remove(0).kind;
                drawing.blocks.insert(name, block);
            }
        }
        _ => {
            if let Some(block) = drawing.blocks.get_mut(OPEN) {
                append(&mut block.entities, entity);
            }
        }
    }
}

/// Vertices go to the polyline before them.
fn append(entities: &mut Vec<Entity>, entity: Entity) {
    match (entity.kind.as_str(), entities.last_mut()) {
        ("VERTEX", Some(last)) if last.kind == "POLYLINE" => last.vertices.push(entity),
        ("SEQEND", _) => {}
        _ => entities.push(entity),
    }
}

fn unit(drawing: &Drawing) -> (f64, UnitState) {
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

/// What the entities of a block take from where it is put.
struct Inherited {
    layer: Option<String>,
    colour: i64,
}

fn add(
    out: &mut Collector,
    drawing: &Drawing,
    entity: &Entity,
    (transform, inherited): (&DAffine2, &Inherited),
    depth: usize,
) -> Result<(), ArtError> {
    if depth > DEEPEST {
        return Err(ArtError::TooDeep);
    }
    // Paper space holds frames and views, not the drawing.
    if entity.flags(67) == 1 || entity.flags(60) == 1 {
        return Ok(());
    }
    let own = entity.text(8).unwrap_or("0");
    let layer = match &inherited.layer {
        Some(outer) if own == "0" => outer.as_str(),
        _ => own,
    };
    let of_layer = drawing.layers.get(layer).copied().unwrap_or(7);
    if of_layer < 0 {
        return Ok(());
    }
    let colour = match entity.number(62).map(|c| c as i64) {
        None | Some(256) => of_layer,
        Some(0) => inherited.colour,
        Some(own) => own,
    };
    // An extrusion downwards looks at the entity from behind.
    let mirrored = entity.number(230).is_some_and(|z| z < 0.0);
    let transform = if mirrored && entity.kind != "LINE" && entity.kind != "POINT" {
        *transform * DAffine2::from_scale(DVec2::new(-1.0, 1.0))
    } else {
        *transform
    };
    let at = |p: DVec2| transform.transform_point2(p);
    match entity.kind.as_str() {
        "INSERT" => return insert(out, drawing, entity, (&transform, layer, colour), depth),
        "TEXT" | "MTEXT" | "ATTRIB" => {
            let text = entity.text(1).unwrap_or_default().to_owned();
            out.text(text, at(entity.point(10).unwrap_or_default()));
        }
        "ATTDEF" | "VIEWPORT" | "SEQEND" => {}
        _ => match outline(entity, &transform) {
            Some((points, closed)) => {
                let operation = Operation::of_name(layer);
                let place = Place { layer, name: None, operation, colour: index_colour(colour) };
                out.path((points.into_iter().map(at).collect(), closed), &place);
            }
            None => out.unread(&entity.kind),
        },
    }
    Ok(())
}

fn insert(
    out: &mut Collector,
    drawing: &Drawing,
    entity: &Entity,
    (transform, layer, colour): (&DAffine2, &str, i64),
    depth: usize,
) -> Result<(), ArtError> {
    let Some(block) = entity.text(2).and_then(|name| drawing.blocks.get(name)) else {
        return Ok(());
    };
    let scale = DVec2::new(entity.number(41).unwrap_or(1.0), entity.number(42).unwrap_or(1.0));
    let turn = DAffine2::from_angle(entity.number(50).unwrap_or(0.0).to_radians());
    let at = entity.point(10).unwrap_or_default();
    let count = |code| entity.number(code).unwrap_or(1.0).clamp(1.0, 1000.0) as usize;
    let step = DVec2::new(entity.number(44).unwrap_or(0.0), entity.number(45).unwrap_or(0.0));
    let inherited = Inherited { layer: Some(layer.to_owned()), colour };
    for row in 0..count(71) {
        for column in 0..count(70) {
            let place = DAffine2::from_translation(at)
                * turn
                * DAffine2::from_translation(step * DVec2::new(column as f64, row as f64))
                * DAffine2::from_scale(scale)
                * DAffine2::from_translation(-block.base);
            for inner in &block.entities {
                add(out, drawing, inner, (&(*transform * place), &inherited), depth + 1)?;
            }
        }
    }
    Ok(())
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
