//! Functions that fit on a screen and files that are read in one sitting; tests are not counted.

use super::Fault;
use super::source::Source;

/// The most lines of a function, from its name to its last brace.
const LONGEST_FUNCTION: usize = 80;
/// The most parameters of a function, `self` among them.
const MOST_PARAMETERS: usize = 7;
/// The most lines of a file above its tests.
const LONGEST_FILE: usize = 600;

/// A function with its place among the tokens.
struct Function<'a> {
    name: &'a str,
    line: usize,
    parameters: usize,
    /// The line of its last brace.
    last_line: usize,
}

pub fn size_faults(source: &Source) -> Vec<Fault> {
    let mut faults = Vec::new();
    for i in 0..source.tokens.len() {
        let Some(Function { name, line, parameters, last_line }) = function_at(source, i) else {
            continue;
        };
        let lines = last_line + 1 - line;
        if lines > LONGEST_FUNCTION {
            let advice = format!(
                "`{name}` has {lines} lines, and {LONGEST_FUNCTION} fit on a screen: give its \
                steps functions with names"
            );
            faults.push(source.fault(line, advice));
        }
        if parameters > MOST_PARAMETERS {
            let advice = format!(
                "`{name}` has {parameters} parameters, and {MOST_PARAMETERS} are the most: make a \
                type of those that belong together"
            );
            faults.push(source.fault(line, advice));
        }
    }
    let lines = source.tokens.last().map_or(0, |token| token.line);
    if lines > LONGEST_FILE {
        let advice = format!("the file has {lines} lines, and {LONGEST_FILE} are the most");
        faults.push(source.fault(lines, advice));
    }
    faults
}

/// The function that begins at a token; none where no function with a body does.
fn function_at(source: &Source, i: usize) -> Option<Function<'_>> {
    if !source.reads(i, &["fn"]) || !source.is_word(i + 1) {
        return None;
    }
    let mut open = i + 2;
    if source.reads(open, &["<"]) {
        open = end_of_generics(source, open)?;
    }
    let close = closing(source, open)?;
    let mut body = close + 1;
    while !source.reads(body, &["{"]) {
        body = match source.tokens.get(body)?.text.as_str() {
            ";" => return None,
            "(" | "[" => closing(source, body)? + 1,
            _ => body + 1,
        };
    }
    Some(Function {
        name: &source.tokens[i + 1].text,
        line: source.tokens[i].line,
        parameters: parameters(source, open, close),
        last_line: source.tokens[closing(source, body)?].line,
    })
}

/// The place after the generics that begin at `start`.
fn end_of_generics(source: &Source, start: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for i in start..source.tokens.len() {
        match source.tokens[i].text.as_str() {
            "<" => depth += 1,
            // The head of an arrow closes nothing.
            ">" if !source.reads(i - 1, &["-"]) => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(i + 1);
        }
    }
    None
}

/// The bracket that closes the one at `open`.
fn closing(source: &Source, open: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (i, token) in source.tokens.iter().enumerate().skip(open) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.checked_sub(1)?,
            _ => {}
        }
        if depth == 0 {
            return Some(i);
        }
    }
    None
}

/// How many parameters stand between two brackets.
fn parameters(source: &Source, open: usize, close: usize) -> usize {
    let (mut count, mut angles, mut is_empty, mut i) = (0, 0_usize, true, open + 1);
    while i < close {
        match source.tokens[i].text.as_str() {
            "(" | "[" | "{" => i = closing(source, i).unwrap_or(close),
            "<" => angles += 1,
            ">" if !source.reads(i - 1, &["-"]) => angles = angles.saturating_sub(1),
            _ => {}
        }
        if source.reads(i, &[","]) && angles == 0 {
            count += usize::from(!is_empty);
            is_empty = true;
        } else {
            is_empty = false;
        }
        i += 1;
    }
    count + usize::from(!is_empty)
}
