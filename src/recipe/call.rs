//! A step made of the fields of its parameter structs, for programs that call steps as functions.
//!
//! A recipe names what a step does by a key, whose value is one of the parameters; a function has a
//! name, and its parameters are called as they are. Everything else is the same, so the same code
//! reads it.

use toml::de::DeTable;

use super::Step;
use super::error::{Position, RecipeError};
use super::fields::{Entry, RecipeText, StepFields};
use super::keys::StepKind;
use super::parameters::Parameters;
use toml::Value;

impl Step {
    /// A step of a kind with the given parameters, by the names of their fields (`profile`, not the
    /// verb `planarize`); a parameter that is left out has its default. The parameter that is one
    /// of the words of the verb (`hull = "dual"`) goes by the name of the verb.
    ///
    /// # Errors
    /// [`RecipeError`] for names that are not known and values that do not fit; its place means
    /// nothing to people, since there is no text, so show [`RecipeError::without_place`].
    ///
    /// # Example
    /// ```
    /// use kerfold::recipe::{Step, steps};
    ///
    /// let cut = steps().iter().find(|kind| kind.kind == Some("edge")).expect("a kind of step");
    /// let step = Step::of_fields(cut, &[("select".to_owned(), "along=z".into())])?;
    /// assert_eq!(step.verb(), "cut edge");
    /// assert!(Step::of_fields(cut, &[("selekt".to_owned(), "along=z".into())]).is_err());
    /// # Ok::<(), kerfold::recipe::RecipeError>(())
    /// ```
    pub fn of_fields(kind: &StepKind, fields: &[(String, Value)]) -> Result<Self, RecipeError> {
        // The first line stands for the key of the verb, where no parameter takes its place.
        let name = |key: &str| if key == kind.field { kind.verb } else { key }.to_owned();
        let named = fields.iter().any(|(key, _)| name(key) == kind.verb);
        let mut text = if named { String::new() } else { format!("{} = \"\"\n", kind.verb) };
        for (key, value) in fields {
            text += &format!("{} = {value}\n", Value::from(name(key)));
        }
        let source = RecipeText { text: &text, parameters: Parameters::default() };
        let table = DeTable::parse(&text).map_err(|error| source.syntax(&error))?;
        let mut all: Vec<Entry<'_>> = table
            .get_ref()
            .iter()
            .map(|(key, value)| Entry { key: key.get_ref().as_ref(), key_span: key.span(), value })
            .collect();
        all.sort_by_key(|entry| entry.key_span.start);
        let is_verb = |entry: &Entry<'_>| entry.key == kind.verb;
        let Some(at) = all.iter().position(is_verb) else {
            let at = Position { line: 1, column: 1 };
            return Err(RecipeError::NoVerb { at, verbs: kind.verb.to_owned() });
        };
        let verb = Entry { key: all[at].key, key_span: all[at].key_span.clone(), ..all[at] };
        if !named {
            all.remove(at);
        }
        let span = 0..text.len();
        let known = kind.known_keys();
        let fields = StepFields { source: &source, known, verb: &verb, entries: &all, span };
        fields.check_keys()?;
        (kind.read)(&fields)
    }
}

#[cfg(test)]
mod tests {
    use super::super::steps;
    use super::*;

    fn step(verb: &str, kind: Option<&str>, fields: &[(&str, Value)]) -> Result<Step, String> {
        let wanted = steps().iter().find(|s| s.verb == verb && s.kind == kind).expect("a kind");
        let fields: Vec<_> = fields.iter().map(|(k, v)| ((*k).to_owned(), v.clone())).collect();
        Step::of_fields(wanted, &fields).map_err(|error| error.without_place())
    }

    #[test]
    fn fields_make_the_same_step_as_a_recipe() {
        let same = |verb: &str, kind: Option<&str>, fields: &[(&str, Value)], text: &str| {
            let ours = step(verb, kind, fields).expect("a step");
            let text = format!("[[step]]\n{text}");
            let theirs = super::super::Recipe::parse(&text).expect("a recipe").steps.remove(0);
            assert_eq!(format!("{ours:?}"), format!("{theirs:?}"), "{text}");
        };
        same("planarize", None, &[], "planarize = \"exact\"");
        same("planarize", None, &[("profile", "glass".into())], "planarize = \"glass\"");
        same("hull", None, &[("hull", "dual".into())], "hull = \"dual\"");
        same("hull", None, &[], "hull = \"convex\"");
        let ids = Value::from(vec![0, 2]);
        same("cut", Some("edge"), &[("select", ids)], "cut = \"edge\"\nselect = [0, 2]");
        // An unfold step has a list of edges called as another verb.
        let lists = [("pieces", "one".into()), ("cut", "3".into())];
        same("unfold", None, &lists, "unfold = \"one\"\ncut = \"3\"");
        // No recipe can leave out the number of triangles.
        assert!(step("simplify", None, &[("deviation", "1mm".into())]).is_ok());
    }

    #[test]
    fn what_does_not_fit_is_told_without_a_place() {
        let error = step("cut", Some("edge"), &[("offsett", 0.2.into())]).expect_err("a name");
        assert_eq!(error, "`offsett` is not known in a step with `cut`; did you mean `offset`?");
        let error = step("cut", Some("edge"), &[]).expect_err("no selection");
        assert_eq!(error, "missing field `select`");
        let error = step("solid", None, &[("name", "kube".into())]).expect_err("no solid");
        assert!(error.contains("cube"), "{error}");
    }
}
