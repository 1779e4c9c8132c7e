//! What stands around the entities of a DXF R2000 file: header, tables, blocks, objects.

use std::fmt::{Display, Write as _};

use super::DxfLayer;
use crate::io::number::decimal;
use crate::sheet::Rgb;

// Handles of everything that is in every file; entities are numbered from `FIRST_FREE` on.
const TABLES: [(&str, u32); 9] = [
    ("VPORT", 0x08),
    ("LTYPE", 0x05),
    ("LAYER", 0x02),
    ("STYLE", 0x03),
    ("VIEW", 0x06),
    ("UCS", 0x07),
    ("APPID", 0x09),
    ("DIMSTYLE", 0x0A),
    ("BLOCK_RECORD", 0x01),
];
const ROOT_DICTIONARY: u32 = 0x0C;
const GROUPS: u32 = 0x0D;
const LAYOUTS: u32 = 0x1A;
pub(super) const MODEL_SPACE: u32 = 0x1F;
const PAPER_SPACE: u32 = 0x1B;
const MODEL_LAYOUT: u32 = 0x22;
const PAPER_LAYOUT: u32 = 0x1E;
const FIRST_LAYER: u32 = 0x40;
const FIRST_FREE: u32 = 0x100;

/// Numbers for entities.
pub(super) struct Handles(u32);

impl Default for Handles {
    fn default() -> Self {
        Self(FIRST_FREE)
    }
}

impl Handles {
    pub fn next(&mut self) -> u32 {
        self.0 += 1;
        self.0 - 1
    }
}

/// Group codes with their values, a line each.
#[derive(Default)]
pub(super) struct Pairs(String);

impl Pairs {
    pub fn text(&mut self, code: u16, value: &str) {
        let _ = writeln!(self.0, "{code:>3}\n{value}");
    }

    pub fn number(&mut self, code: u16, value: impl Display) {
        self.text(code, &value.to_string());
    }

    pub fn handle(&mut self, code: u16, value: u32) {
        let _ = writeln!(self.0, "{code:>3}\n{value:X}");
    }

    fn point(&mut self, code: u16, [x, y]: [f64; 2]) {
        for (i, value) in [x, y, 0.0].into_iter().enumerate() {
            self.text(code + 10 * i as u16, &decimal(value));
        }
    }

    fn section(&mut self, name: &str, body: impl FnOnce(&mut Self)) {
        self.text(0, "SECTION");
        self.text(2, name);
        body(self);
        self.text(0, "ENDSEC");
    }
}

/// The whole file.
pub(super) fn file(
    size: [f64; 2],
    layers: &[DxfLayer<'_>],
    command: &str,
    (entities, handles): (&Pairs, &Handles),
) -> String {
    let mut out = Pairs::default();
    out.text(999, &plain(command));
    out.section("HEADER", |out| header(out, size, handles.0));
    out.section("CLASSES", |_| {});
    out.section("TABLES", |out| tables(out, size, layers));
    out.section("BLOCKS", |out| {
        block(out, "*Model_Space", MODEL_SPACE, [0x20, 0x21]);
        block(out, "*Paper_Space", PAPER_SPACE, [0x1C, 0x1D]);
    });
    out.section("ENTITIES", |out| out.0 += &entities.0);
    out.section("OBJECTS", |out| objects(out, size));
    out.text(0, "EOF");
    out.0
}

/// Text that every reader of R2000 takes: ASCII, other characters by their number.
pub(in crate::io) fn plain(text: &str) -> String {
    text.chars().fold(String::new(), |mut plain, c| {
        match c {
            ' '..='~' => plain.push(c),
            c if c.is_control() => plain.push(' '),
            c => plain += &format!("\\U+{:04X}", u32::from(c)),
        }
        plain
    })
}

fn header(out: &mut Pairs, size: [f64; 2], seed: u32) {
    let mut variable = |name: &str, code: u16, value: &str| {
        out.text(9, name);
        out.text(code, value);
    };
    variable("$ACADVER", 1, "AC1015");
    variable("$DWGCODEPAGE", 3, "ANSI_1252");
    variable("$LUNITS", 70, "2");
    variable("$LUPREC", 70, "4");
    variable("$LTSCALE", 40, "1.0");
    variable("$CLAYER", 8, "0");
    variable("$INSUNITS", 70, "4");
    variable("$MEASUREMENT", 70, "1");
    variable("$HANDSEED", 5, &format!("{seed:X}"));
    for (name, point) in [("$INSBASE", [0.0; 2]), ("$EXTMIN", [0.0; 2]), ("$EXTMAX", size)] {
        out.text(9, name);
        out.point(10, point);
    }
    for (name, [x, y]) in [("$LIMMIN", [0.0; 2]), ("$LIMMAX", size)] {
        out.text(9, name);
        out.text(10, &decimal(x));
        out.text(20, &decimal(y));
    }
}

fn tables(out: &mut Pairs, size: [f64; 2], rows: &[DxfLayer<'_>]) {
    for (name, handle) in TABLES {
        let mut entries = Pairs::default();
        let count = match name {
            "VPORT" => view_port(&mut entries, handle, size),
            "LTYPE" => line_types(&mut entries, handle),
            "LAYER" => layers(&mut entries, handle, rows),
            "STYLE" => text_style(&mut entries, handle),
            "APPID" => application(&mut entries, handle),
            "DIMSTYLE" => dimension_style(&mut entries, handle),
            "BLOCK_RECORD" => block_records(&mut entries, handle),
            _ => 0,
        };
        out.text(0, "TABLE");
        out.text(2, name);
        out.handle(5, handle);
        out.handle(330, 0);
        out.text(100, "AcDbSymbolTable");
        out.number(70, count);
        if name == "DIMSTYLE" {
            out.text(100, "AcDbDimStyleTable");
            out.number(71, 0);
        }
        out.0 += &entries.0;
        out.text(0, "ENDTAB");
    }
}

/// The head of an entry of a table.
fn entry(out: &mut Pairs, (kind, class): (&str, &str), (handle, table): (u32, u32), name: &str) {
    out.text(0, kind);
    out.handle(if kind == "DIMSTYLE" { 105 } else { 5 }, handle);
    out.handle(330, table);
    out.text(100, "AcDbSymbolTableRecord");
    out.text(100, class);
    out.text(2, name);
}

fn view_port(out: &mut Pairs, table: u32, [width, height]: [f64; 2]) -> usize {
    entry(out, ("VPORT", "AcDbViewportTableRecord"), (0x29, table), "*Active");
    out.number(70, 0);
    let pairs = [
        (10, 0.0),
        (20, 0.0),
        (11, 1.0),
        (21, 1.0),
        (12, width / 2.0),
        (22, height / 2.0),
        (13, 0.0),
        (23, 0.0),
        (14, 10.0),
        (24, 10.0),
        (15, 10.0),
        (25, 10.0),
        (16, 0.0),
        (26, 0.0),
        (36, 1.0),
        (17, 0.0),
        (27, 0.0),
        (37, 0.0),
        (40, height * 1.05),
        (41, width / height),
        (42, 50.0),
        (43, 0.0),
        (44, 0.0),
        (50, 0.0),
        (51, 0.0),
    ];
    pairs.into_iter().for_each(|(code, value)| out.text(code, &decimal(value)));
    [(71, 0), (72, 100), (73, 1), (74, 3), (75, 0), (76, 0), (77, 0), (78, 0)]
        .into_iter()
        .for_each(|(code, value)| out.number(code, value));
    1
}

fn line_types(out: &mut Pairs, table: u32) -> usize {
    let rows: [(&str, u32, &str, &[f64]); 4] = [
        ("ByBlock", 0x14, "", &[]),
        ("ByLayer", 0x15, "", &[]),
        ("Continuous", 0x16, "Solid line", &[]),
        ("DASHED", 0x17, "Dashed __ __ __ __", &[2.0, -2.0]),
    ];
    for (name, handle, shown, pattern) in rows {
        entry(out, ("LTYPE", "AcDbLinetypeTableRecord"), (handle, table), name);
        out.number(70, 0);
        out.text(3, shown);
        out.number(72, 65);
        out.number(73, pattern.len());
        out.text(40, &format!("{:.1}", pattern.iter().map(|p| p.abs()).sum::<f64>()));
        for dash in pattern {
            out.text(49, &format!("{dash:.1}"));
            out.number(74, 0);
        }
    }
    rows.len()
}

/// The colours of the index that look like those of sheets.
const INDEX: [(u8, Rgb); 9] = [
    (1, [255, 0, 0]),
    (2, [255, 255, 0]),
    (3, [0, 255, 0]),
    (4, [0, 255, 255]),
    (5, [0, 0, 255]),
    (6, [255, 0, 255]),
    // Black on white, white on black.
    (7, [0, 0, 0]),
    (8, [128, 128, 128]),
    (30, [255, 127, 0]),
];

/// The colour of the index that is nearest to a colour.
pub(super) fn index_of(colour: Rgb) -> u8 {
    let distance = |other: &Rgb| -> u32 {
        colour.iter().zip(other).map(|(&a, &b)| u32::from(a.abs_diff(b)).pow(2)).sum()
    };
    INDEX.iter().min_by_key(|(_, rgb)| distance(rgb)).map_or(7, |&(index, _)| index)
}

/// A line weight in hundredths of a millimetre: 20, or the thinnest there is.
pub(super) fn weight(width: f64) -> u8 {
    if width < 0.1 { 0 } else { 20 }
}

fn layers(out: &mut Pairs, table: u32, rows: &[DxfLayer<'_>]) -> usize {
    let plain = DxfLayer { name: "0", colour: 7, weight: 20, is_dashed: false, is_plotted: true };
    let all = std::iter::once((0x10, &plain)).chain((FIRST_LAYER..).zip(rows));
    for (handle, layer) in all {
        let class = ("LAYER", "AcDbLayerTableRecord");
        entry(out, class, (handle, table), layer.name);
        out.number(70, 0);
        out.number(62, layer.colour);
        out.text(6, if layer.is_dashed { "DASHED" } else { "Continuous" });
        if !layer.is_plotted {
            out.number(290, 0);
        }
        out.number(370, layer.weight);
        // Plot style: the dictionary's one place holder.
        out.handle(390, 0x0F);
    }
    1 + rows.len()
}

fn text_style(out: &mut Pairs, table: u32) -> usize {
    entry(out, ("STYLE", "AcDbTextStyleTableRecord"), (0x11, table), "Standard");
    [(70, "0"), (40, "0.0"), (41, "1.0"), (50, "0.0"), (71, "0"), (42, "2.5"), (3, "txt"), (4, "")]
        .into_iter()
        .for_each(|(code, value)| out.text(code, value));
    1
}

fn application(out: &mut Pairs, table: u32) -> usize {
    entry(out, ("APPID", "AcDbRegAppTableRecord"), (0x12, table), "ACAD");
    out.number(70, 0);
    1
}

fn dimension_style(out: &mut Pairs, table: u32) -> usize {
    entry(out, ("DIMSTYLE", "AcDbDimStyleTableRecord"), (0x27, table), "Standard");
    out.number(70, 0);
    out.handle(340, 0x11);
    1
}

fn block_records(out: &mut Pairs, table: u32) -> usize {
    for (name, handle, layout) in
        [("*Model_Space", MODEL_SPACE, MODEL_LAYOUT), ("*Paper_Space", PAPER_SPACE, PAPER_LAYOUT)]
    {
        entry(out, ("BLOCK_RECORD", "AcDbBlockTableRecord"), (handle, table), name);
        out.handle(340, layout);
    }
    2
}

fn block(out: &mut Pairs, name: &str, record: u32, [begin, end]: [u32; 2]) {
    let head = |out: &mut Pairs, kind: &str, handle: u32, class: &str| {
        out.text(0, kind);
        out.handle(5, handle);
        out.handle(330, record);
        out.text(100, "AcDbEntity");
        if record == PAPER_SPACE {
            out.number(67, 1);
        }
        out.text(8, "0");
        out.text(100, class);
    };
    head(out, "BLOCK", begin, "AcDbBlockBegin");
    out.text(2, name);
    out.number(70, 0);
    out.point(10, [0.0; 2]);
    out.text(3, name);
    out.text(1, "");
    head(out, "ENDBLK", end, "AcDbBlockEnd");
}

fn objects(out: &mut Pairs, size: [f64; 2]) {
    let dictionary = |out: &mut Pairs, handle: u32, owner: u32, entries: &[(&str, u32)]| {
        out.text(0, "DICTIONARY");
        out.handle(5, handle);
        out.handle(330, owner);
        out.text(100, "AcDbDictionary");
        out.number(281, 1);
        for (name, value) in entries {
            out.text(3, name);
            out.handle(350, *value);
        }
    };
    let of_root = [("ACAD_GROUP", GROUPS), ("ACAD_LAYOUT", LAYOUTS), ("ACAD_PLOTSTYLENAME", 0x0E)];
    dictionary(out, ROOT_DICTIONARY, 0, &of_root);
    dictionary(out, GROUPS, ROOT_DICTIONARY, &[]);
    dictionary(
        out,
        LAYOUTS,
        ROOT_DICTIONARY,
        &[("Model", MODEL_LAYOUT), ("Layout1", PAPER_LAYOUT)],
    );
    out.text(0, "ACDBDICTIONARYWDFLT");
    out.handle(5, 0x0E);
    out.handle(330, ROOT_DICTIONARY);
    out.text(100, "AcDbDictionary");
    out.number(281, 1);
    out.text(3, "Normal");
    out.handle(350, 0x0F);
    out.text(100, "AcDbDictionaryWithDefault");
    out.handle(340, 0x0F);
    out.text(0, "ACDBPLACEHOLDER");
    out.handle(5, 0x0F);
    out.handle(330, 0x0E);
    layout(out, ("Model", 0, MODEL_LAYOUT, MODEL_SPACE), size);
    layout(out, ("Layout1", 1, PAPER_LAYOUT, PAPER_SPACE), size);
}

/// A layout: its settings for plotting at true size, and which block it shows.
fn layout(out: &mut Pairs, (name, order, handle, record): (&str, u32, u32, u32), size: [f64; 2]) {
    out.text(0, "LAYOUT");
    out.handle(5, handle);
    out.handle(330, LAYOUTS);
    out.text(100, "AcDbPlotSettings");
    [(1, ""), (2, "none_device"), (4, ""), (6, "")]
        .into_iter()
        .for_each(|(code, value)| out.text(code, value));
    (40..=49).chain(140..=141).for_each(|code| out.text(code, "0.0"));
    out.text(142, "1.0");
    out.text(143, "1.0");
    // 1024: the model's settings; paper units are millimetres, the whole drawing is plotted.
    [(70, if record == MODEL_SPACE { 1712 } else { 688 }), (72, 1), (73, 0), (74, 5)]
        .into_iter()
        .for_each(|(code, value)| out.number(code, value));
    out.text(7, "");
    out.number(75, 16);
    out.text(147, "1.0");
    out.text(148, "0.0");
    out.text(149, "0.0");
    out.text(100, "AcDbLayout");
    out.text(1, name);
    out.number(70, 1);
    out.number(71, order);
    for (code, [x, y]) in [(10, [0.0; 2]), (11, size)] {
        out.text(code, &decimal(x));
        out.text(code + 10, &decimal(y));
    }
    out.point(12, [0.0; 2]);
    out.point(14, [0.0; 2]);
    out.point(15, size);
    out.text(146, "0.0");
    out.point(13, [0.0; 2]);
    out.point(16, [1.0, 0.0]);
    out.point(17, [0.0, 1.0]);
    out.number(76, 0);
    out.handle(330, record);
}
