//! Tables, charts, cards of panels and terms on paper.

use super::font::Font;
use super::paper::{Anchor, BAD, INK, LEFT, LINE, Paper, Pen, Role, SOFT, WIDTH};
use super::{BODY, BOLD, GAP, GUTTER, SMALL, picture, plain, verdict_colour};
use crate::io::report::page::words::verdict;
use crate::io::report::page::{Block, Chart, PanelCard, Table, Word, Words};

const CELL: Pen = Pen::new(Font::Regular, 8.5, INK);
const HEAD: Pen = Pen::new(Font::Bold, 8.5, INK);
const TICK: Pen = Pen::new(Font::Regular, 7.5, INK);
const COUNT: Pen = Pen::new(Font::Regular, 7.5, SOFT);
/// Free room at the sides of a cell.
const PADDING: f64 = 5.0;
/// Height of a line in a table, and what a row has beyond its lines.
const LINE_HEIGHT: f64 = 10.5;
const ROW_EXTRA: f64 = 4.0;

/// Height of a chart, of its bars, and from its top to the highest bar.
const CHART: [f64; 3] = [148.0, 88.0, 24.0];
/// Cards side by side.
const CARDS: usize = 3;
/// Height of a line of a card.
const CARD_LINE: f64 = 11.0;

/// How much of a block must be on the page of its heading.
pub(super) fn least_room(block: &Block<'_>) -> f64 {
    match block {
        Block::Text(words) => {
            BODY.font.wrap(&plain(words), BODY.size, WIDTH).len() as f64 * BODY.leading() + GAP
        }
        Block::Note(words) => {
            SMALL.font.wrap(&plain(words), SMALL.size, WIDTH).len() as f64 * SMALL.leading() + GAP
        }
        Block::Table(_) | Block::Terms(_) => 4.0 * (LINE_HEIGHT + ROW_EXTRA),
        Block::Chart(_) => CHART[0],
        Block::Panels(cards) => cards.first().map_or(0.0, card_height),
    }
}

/// A table, its head once more on every page.
pub(super) fn table(paper: &mut Paper, table: &Table) {
    let cells: Vec<Vec<String>> =
        table.rows.iter().map(|row| row.iter().map(|words| plain(words)).collect()).collect();
    let columns = columns(table, &cells);
    paper.part(Role::Table, |paper| {
        head(paper, table, &columns);
        for (row, cells) in table.rows.iter().zip(&cells) {
            table_row(paper, table, &columns, row, cells);
        }
    });
}

fn table_row(
    paper: &mut Paper,
    table: &Table,
    columns: &[Column],
    row: &[Words],
    cells: &[String],
) {
    let wrapped =
        |(column, text): (&Column, &String)| CELL.font.wrap(text, CELL.size, column.room());
    let lines: Vec<Vec<String>> = columns.iter().zip(cells).map(wrapped).collect();
    let height = lines.iter().map(Vec::len).max().unwrap_or(1) as f64 * LINE_HEIGHT + ROW_EXTRA;
    if paper.need(height) {
        head(paper, table, columns);
    }
    paper.part(Role::Row, |paper| {
        for ((column, lines), words) in columns.iter().zip(&lines).zip(row) {
            paper.part(Role::Cell, |paper| {
                for (k, line) in lines.iter().enumerate() {
                    let base = paper.y + (k + 1) as f64 * LINE_HEIGHT - 1.0;
                    column.write(paper, base, cell_pen(words), line);
                }
            });
        }
    });
    paper.y += height;
    paper.line([LEFT, paper.y], [LEFT + WIDTH, paper.y], LINE, 0.5);
}

fn cell_pen(words: &Words) -> Pen {
    match words.as_slice() {
        [Word::Verdict(is_kept)] => Pen { colour: verdict_colour(*is_kept), ..HEAD },
        _ => CELL,
    }
}

fn head(paper: &mut Paper, table: &Table, columns: &[Column]) {
    paper.need(4.0 * (LINE_HEIGHT + ROW_EXTRA));
    paper.part(Role::Row, |paper| {
        for (column, name) in columns.iter().zip(table.head) {
            paper.part(Role::HeadCell, |paper| {
                column.write(paper, paper.y + LINE_HEIGHT - 1.0, HEAD, name);
            });
        }
    });
    paper.y += LINE_HEIGHT + ROW_EXTRA;
    paper.line([LEFT, paper.y], [LEFT + WIDTH, paper.y], INK, 0.9);
}

struct Column {
    left: f64,
    width: f64,
    is_text: bool,
}

impl Column {
    fn room(&self) -> f64 {
        // Widths were found by the same sums; a hair more keeps rounding from breaking lines.
        self.width - 2.0 * PADDING + 1e-6
    }

    fn write(&self, paper: &mut Paper, base: f64, pen: Pen, text: &str) {
        let (anchor, x) = if self.is_text {
            (Anchor::Start, self.left + PADDING)
        } else {
            (Anchor::End, self.left + self.width - PADDING)
        };
        paper.text([x, base], anchor, pen, text);
    }
}

/// Columns as wide as their widest cell; what is left goes to the wide one, or to all alike.
fn columns(table: &Table, cells: &[Vec<String>]) -> Vec<Column> {
    let natural = |i: usize| {
        let cells =
            cells.iter().filter_map(|row| row.get(i)).map(|text| CELL.font.width(text, CELL.size));
        cells.fold(HEAD.font.width(table.head[i], HEAD.size), f64::max) + 2.0 * PADDING
    };
    let mut widths: Vec<f64> = (0..table.head.len()).map(natural).collect();
    let wide = table.wide_column();
    if let Some(i) = wide {
        widths[i] = 0.0;
    }
    let free = WIDTH - widths.iter().sum::<f64>();
    match wide {
        Some(i) => widths[i] = free,
        None => {
            let share = free / widths.len() as f64;
            widths.iter_mut().for_each(|width| *width += share);
        }
    }
    let mut left = LEFT;
    let column = |(i, width): (usize, f64)| {
        let column = Column { left, width, is_text: i == 0 || wide == Some(i) };
        left += width;
        column
    };
    widths.into_iter().enumerate().map(column).collect()
}

/// Bars with a count above each that is not empty.
pub(super) fn chart(paper: &mut Paper, chart: &Chart) {
    paper.need(CHART[0]);
    paper.part(Role::Figure(chart.axis.to_owned()), |paper| draw_chart(paper, chart));
}

fn draw_chart(paper: &mut Paper, chart: &Chart) {
    let [height, room, top] = CHART;
    let base = paper.y + top + room;
    let most = chart.bars.iter().map(|bar| bar.count).max().unwrap_or(0).max(1) as f64;
    let step = WIDTH / chart.bars.len().max(1) as f64;
    let thick = (0.84 * step).min(46.0);
    for (i, bar) in chart.bars.iter().enumerate() {
        let middle = LEFT + (i as f64 + 0.5) * step;
        if bar.count > 0 {
            // What is there is seen, be it one of a million.
            let tall = (bar.count as f64 / most * room).max(1.0);
            paper.fill([middle - thick / 2.0, base - tall], [thick, tall], bar.colour());
            paper.text([middle, base - tall - 3.0], Anchor::Middle, COUNT, &bar.count.to_string());
        }
        paper.text([middle, base + 10.0], Anchor::Middle, TICK, &bar.label);
    }
    paper.line([LEFT, base], [LEFT + WIDTH, base], INK, 0.8);
    if let Some((at, words)) = chart.limit {
        let x = LEFT + at * step;
        paper.dashes(x, paper.y + 2.0, base, BAD);
        let pen = Pen { colour: BAD, ..COUNT };
        let (anchor, shift) =
            if at * step > WIDTH / 2.0 { (Anchor::End, -4.0) } else { (Anchor::Start, 4.0) };
        paper.text([x + shift, paper.y + 9.0], anchor, pen, words);
    }
    paper.text([LEFT + WIDTH / 2.0, base + 24.0], Anchor::Middle, SMALL, chart.axis);
    paper.y += height;
}

/// Cards of the worst panels, some side by side.
pub(super) fn panels(paper: &mut Paper, cards: &[PanelCard<'_>]) {
    for row in cards.chunks(CARDS) {
        let height = row.iter().map(card_height).fold(0.0, f64::max);
        paper.need(height + GUTTER);
        for (i, card) in row.iter().enumerate() {
            draw_card(paper, card, LEFT + i as f64 * (card_width() + GUTTER), height);
        }
        paper.y += height + GUTTER;
    }
}

fn card_width() -> f64 {
    (WIDTH - (CARDS - 1) as f64 * GUTTER) / CARDS as f64
}

/// Width of one of the two pictures of a card.
fn picture_width() -> f64 {
    (card_width() - 2.0 * 8.0 - 6.0) / 2.0
}

fn card_height(card: &PanelCard<'_>) -> f64 {
    // Pictures of panels are four by three.
    26.0 + 0.75 * picture_width() + (card.figures.len() + 1) as f64 * CARD_LINE + 10.0
}

fn draw_card(paper: &mut Paper, card: &PanelCard<'_>, x: f64, height: f64) {
    let (top, width) = (paper.y, card_width());
    paper.frame([x, top], [width, height], LINE);
    paper.part(Role::Paragraph, |paper| {
        paper.text([x + 8.0, top + 16.0], Anchor::Start, BOLD, &card.name);
        let pen = Pen { colour: verdict_colour(card.is_kept), ..HEAD };
        paper.text([x + width - 8.0, top + 16.0], Anchor::End, pen, verdict(card.is_kept));
    });
    let pictures = [(&card.pictures.close, "close"), (&card.pictures.place, "in its place")];
    for (i, (png, how)) in pictures.into_iter().enumerate() {
        if let Some(image) = picture(png) {
            let left = x + 8.0 + i as f64 * (picture_width() + 6.0);
            let shows = format!("{}, {how}", card.name);
            paper.image([left, top + 24.0], picture_width(), &image, &shows);
        }
    }
    let mut base = top + 24.0 + 0.75 * picture_width() + CARD_LINE + 2.0;
    paper.part(Role::Paragraph, |paper| {
        paper.text([x + 8.0, base], Anchor::Start, SMALL, &card.sides);
        for (figure, unit) in &card.figures {
            base += CARD_LINE;
            paper.text([x + width / 2.0 - 3.0, base], Anchor::End, HEAD, &plain(figure));
            paper.text([x + width / 2.0 + 3.0, base], Anchor::Start, SMALL, unit);
        }
    });
}

/// Terms on the left, what they mean on the right.
pub(super) fn terms(paper: &mut Paper, terms: &[(&str, &str)]) {
    const TERM: f64 = 92.0;
    for (name, meaning) in terms {
        let lines = BODY.font.wrap(meaning, BODY.size, WIDTH - TERM);
        paper.need(lines.len() as f64 * BODY.leading());
        paper.part(Role::Paragraph, |paper| {
            for (k, line) in lines.iter().enumerate() {
                paper.y += BODY.leading();
                if k == 0 {
                    paper.text([LEFT, paper.y], Anchor::Start, BOLD, name);
                }
                paper.text([LEFT + TERM, paper.y], Anchor::Start, BODY, line);
            }
        });
        paper.y += GAP / 2.0;
    }
}
