//! A step as one would type it in a shell: what files say of their making, whoever made them.

use clap::{Arg, ArgAction, Args, Command};
use toml::Value;

use super::keys::StepKind;
use crate::io::ReadOptions;

/// Words as they are typed in a shell, in quotes where it would need them.
pub fn shell_text<T: AsRef<str>>(words: &[T]) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+@%".contains(c);
    let quoted = |word: &T| {
        let word = word.as_ref();
        let is_plain = !word.is_empty() && word.chars().all(plain);
        if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
    };
    words.iter().map(quoted).collect::<Vec<_>>().join(" ")
}

/// The command line that does what a step of a kind with these fields does
/// ([`super::Step::of_fields`]), options in their order. Fields may also be those of
/// [`ReadOptions`], which verbs that read a mesh take as well. `input` is the mesh, `-` for standard
/// input; `output` the file or folder to write.
///
/// # Example
/// ```
/// use kerfold::recipe::{shell_line, steps};
///
/// let cut = steps().iter().find(|kind| kind.kind == Some("edge")).expect("a kind of step");
/// let fields = [("select".to_owned(), "fold>30deg".into()), ("offset".to_owned(), 0.3.into())];
/// assert_eq!(
///     shell_line(cut, &fields, Some("cube.obj"), Some("cut.obj")),
///     "kerfold cut edge cube.obj --select 'fold>30deg' --offset 0.3 -o cut.obj"
/// );
/// ```
pub fn shell_line(
    kind: &StepKind,
    fields: &[(String, Value)],
    input: Option<&str>,
    output: Option<&str>,
) -> String {
    let command = kind.command();
    let reading = ReadOptions::augment_args(Command::new("read"));
    let find = |key: &str| {
        let mut all = command.get_arguments().chain(reading.get_arguments());
        all.find(|arg| arg.get_id().as_str() == key)
    };
    let mut words = vec!["kerfold".to_owned(), kind.verb.to_owned()];
    words.extend(kind.kind.map(str::to_owned));
    let mut options = Vec::new();
    for (key, value) in fields {
        let is_word = key == kind.verb && !kind.words.is_empty();
        let typed = |word: &&(&str, &str)| Value::from(word.0.trim_matches('"')) == *value;
        let word = kind.words.iter().find(typed).filter(|_| is_word);
        let value = word.map_or_else(|| value.clone(), |(_, switch)| meant(switch));
        match find(if is_word { kind.field } else { key }) {
            None => {}
            Some(arg) if arg.is_positional() => words.extend(values(&value)),
            Some(arg) => option(arg, &value, &mut options),
        }
    }
    words.extend(input.map(str::to_owned));
    words.append(&mut options);
    words.extend(output.into_iter().flat_map(|output| ["-o".to_owned(), output.to_owned()]));
    shell_text(&words)
}

/// What a word of a recipe stands for.
fn meant(switch: &str) -> Value {
    switch.parse::<bool>().map_or_else(|_| Value::from(switch.trim_matches('"')), Value::from)
}

fn option(arg: &Arg, value: &Value, words: &mut Vec<String>) {
    let name = format!("--{}", arg.get_long().unwrap_or(arg.get_id().as_str()));
    if !arg.get_action().takes_values() {
        words.extend(value.as_bool().filter(|&is_on| is_on).map(|_| name));
        return;
    }
    let values = values(value);
    // Options that are typed once for each value, and those that take several at once.
    let many = arg.get_num_args().is_some_and(|n| n.max_values() > 1);
    if arg.get_value_delimiter().is_none() && many {
        words.push(name);
        words.extend(values);
    } else if arg.get_value_delimiter().is_none() && matches!(arg.get_action(), ArgAction::Append) {
        values.into_iter().for_each(|value| pair(arg, &name, value, words));
    } else {
        pair(arg, &name, values.join(","), words);
    }
}

/// A value of its own word where the command line takes it so, else after a `=`.
fn pair(arg: &Arg, name: &str, value: String, words: &mut Vec<String>) {
    let is_number = value.parse::<f64>().is_ok();
    let may_begin_so = !value.starts_with('-')
        || arg.is_allow_hyphen_values_set()
        || arg.is_allow_negative_numbers_set() && is_number;
    if arg.is_require_equals_set() || !may_begin_so {
        words.push(format!("{name}={value}"));
    } else {
        words.extend([name.to_owned(), value]);
    }
}

fn values(value: &Value) -> Vec<String> {
    match value {
        Value::String(text) => vec![text.clone()],
        Value::Array(list) => list.iter().flat_map(values).collect(),
        other => vec![other.to_string()],
    }
}

#[cfg(test)]
mod tests {
    use super::super::steps;
    use super::*;

    fn line(verb: &str, kind: Option<&str>, fields: &[(&str, Value)]) -> String {
        let wanted = steps().iter().find(|s| s.verb == verb && s.kind == kind).expect("a kind");
        let fields: Vec<_> = fields.iter().map(|(k, v)| ((*k).to_owned(), v.clone())).collect();
        shell_line(wanted, &fields, Some("in.obj"), Some("out"))
    }

    #[test]
    fn values_are_typed_as_the_command_line_takes_them() {
        let plane = [("normal", "-z".into()), ("point", "0,0,1cm".into())];
        let typed = line("cut", Some("plane"), &plane);
        assert_eq!(typed, "kerfold cut plane in.obj --normal -z --point 0,0,1cm -o out");
        let ids = [("select", Value::from(vec![3, 7])), ("disjoint", "yes".into())];
        assert_eq!(
            line("cut", Some("edge"), &ids),
            "kerfold cut edge in.obj --select 3,7 --disjoint=yes -o out"
        );
        let scheme = [("scheme", "doo-sabin".into()), ("rounds", 2.into())];
        assert_eq!(
            line("subdivide", None, &scheme),
            "kerfold subdivide doo-sabin in.obj --rounds 2 -o out"
        );
        assert_eq!(
            line("hull", None, &[("hull", "dual".into())]),
            "kerfold hull in.obj --dual -o out"
        );
        assert_eq!(line("hull", None, &[("hull", "convex".into())]), "kerfold hull in.obj -o out");
        let weights = [("from", "2".into()), ("weights", "-3mm,-3mm".into())];
        assert_eq!(
            line("handle", None, &weights),
            "kerfold handle in.obj --from 2 --weights -3mm,-3mm -o out"
        );
    }

    #[test]
    fn quotes_stand_where_a_shell_needs_them() {
        assert_eq!(shell_text(&["a b", "it's", "", "x=1"]), r"'a b' 'it'\''s' '' x=1");
    }
}
