use super::*;
use crate::progress::Silent;
use crate::shape;
use glam::DVec3;
use proptest::prelude::*;

fn select(text: &str) -> Selection {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn message(text: &str) -> String {
    text.parse::<Selection>().expect_err(text).to_string()
}

/// The box has its vertex i at the high end of x, y, z where bit 0, 1, 2 of i is set; faces: below,
/// above, front, back, left, right; extents 60, 40, 20.
fn boxed() -> Mesh {
    shape::cuboid(DVec3::new(60.0, 40.0, 20.0))
}

fn counts(mesh: &Mesh, text: &str) -> [usize; 3] {
    let context = Context::of(mesh);
    let selection = select(text);
    let count = |result: Result<usize, SelectError>| match result {
        Ok(count) => count,
        Err(SelectError::Empty { .. }) => 0,
        Err(SelectError::WrongKind { .. }) => 99,
        Err(error) => panic!("{text}: {error}"),
    };
    [
        count(selection.vertices(&context).map(|v| v.len())),
        count(selection.edges(&context).map(|e| e.len())),
        count(selection.faces(&context).map(|f| f.len())),
    ]
}

#[test]
fn what_each_condition_means_on_a_box() {
    let mesh = boxed();
    for (text, expected) in [
        ("all", [8, 12, 6]),
        ("0,2-4", [4, 4, 4]),
        ("4,4,2-4", [3, 3, 3]),
        ("valence=3", [8, 12, 6]),
        ("valence!=3", [0, 0, 0]),
        ("valence>=3 & valence<=3", [8, 12, 6]),
        ("sides=4", [99, 99, 6]),
        ("sides<4", [99, 99, 0]),
        ("fold=90deg", [99, 12, 99]),
        ("fold>90", [99, 0, 99]),
        ("fold<0.25turn", [99, 0, 99]),
        ("along=z", [99, 4, 99]),
        ("along=-z:0deg", [99, 4, 99]),
        ("along=1,1,0:44deg", [99, 0, 99]),
        ("along=1,1,0:46deg", [99, 8, 99]),
        ("along=1,1,0:90deg", [99, 12, 99]),
        ("above=z:0mm", [4, 4, 1]),
        ("above=z:10mm", [0, 0, 0]),
        ("above=z:9.99mm", [4, 4, 1]),
        ("below=z:1cm", [4, 4, 1]),
        ("above=-z:9mm", [4, 4, 1]),
        ("above=1,1,1:0mm", [3, 2, 0]),
        ("normal=z:20deg", [0, 99, 1]),
        ("normal=z:90deg", [4, 99, 5]),
        ("normal=1,1,1:0.001deg", [1, 99, 0]),
        ("!above=z:0mm", [4, 8, 5]),
        ("above=z:0 & above=x:0", [2, 1, 0]),
        ("above=z:0 | above=x:0", [6, 7, 2]),
        ("!(above=z:0 | above=x:0)", [2, 5, 4]),
        ("above=x:0 | above=y:0 & above=z:0", [5, 5, 1]),
        ("(above=x:0 | above=y:0) & above=z:0", [3, 2, 0]),
        ("!all", [0, 0, 0]),
    ] {
        assert_eq!(counts(&mesh, text), expected, "{text}");
    }
}

#[test]
fn ids_come_ascending_and_every_one_must_exist() {
    let mesh = boxed();
    let context = Context::of(&mesh);
    let chosen = select("7,3,3,0-1").vertices(&context).expect("four");
    assert_eq!(chosen, [0, 1, 3, 7].map(VertexId::new));
    let error = |text: &str| select(text).faces(&context).expect_err(text).to_string();
    assert_eq!(error("2,6"), "there is no face 6; the mesh has 6 faces, numbered from 0 to 5");
    assert_eq!(
        error("0-4294967295"),
        "there is no face 6; the mesh has 6 faces, numbered from 0 to 5"
    );
    assert_eq!(
        select("all").edges(&Context::of(&Mesh::new())).expect_err("nothing").to_string(),
        "`all` selects no edge"
    );
}

#[test]
fn computed_points_are_not_above_their_own_height_by_rounding() {
    // The upper five of these vertices differ by ulps, the two equators of the icosahedron too.
    let mesh = shape::antiprism(5, 7.0);
    let top = mesh.bounds().expect("vertices").1.z;
    assert_eq!(counts(&mesh, &format!("above=z:{}mm", top * (1.0 - 1e-14))), [0, 0, 0]);
    assert_eq!(counts(&mesh, &format!("above=z:{}mm", top * (1.0 - 1e-9))), [5, 5, 1]);
}

#[test]
fn faces_are_told_apart_by_sides_and_groups() {
    let mut mesh = shape::soccer_ball(10.0);
    assert_eq!(counts(&mesh, "sides=5"), [99, 99, 12]);
    assert_eq!(counts(&mesh, "sides=5 | sides=6"), [99, 99, 32]);
    let black: Vec<FaceId> = select("sides=5").faces(&Context::of(&mesh)).expect("twelve");
    black.iter().for_each(|&f| mesh.set_group(f, "black & (flat)"));
    mesh.set_group(FaceId::new(31), "white");
    assert_eq!(counts(&mesh, "group=\"black & (flat)\""), [60, 60, 12]);
    let error = |text: &str| select(text).faces(&Context::of(&mesh)).expect_err(text).to_string();
    assert_eq!(
        error("group=whyte"),
        "no face belongs to a group called `whyte`; did you mean `white`?"
    );
    assert!(error("group=roof").ends_with("the groups are black & (flat), white"));
    assert_eq!(
        select("group=a").edges(&Context::of(&boxed())).expect_err("no groups").to_string(),
        "no face belongs to a group called `a`; the mesh has no groups"
    );
}

#[test]
fn rims_have_no_fold_and_holes_are_no_faces() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let mesh =
        Mesh::from_faces([at(0., 0.), at(1., 0.), at(1., 1.), at(0., 1.)], [[0, 1, 2], [0, 2, 3]])
            .expect("a sheet");
    assert_eq!(counts(&mesh, "all"), [4, 5, 2]);
    assert_eq!(counts(&mesh, "fold>=0"), [99, 1, 99]);
    assert_eq!(counts(&mesh, "!fold>=0"), [99, 4, 99]);
    assert!(matches!(
        select("2").faces(&Context::of(&mesh)),
        Err(SelectError::NoSuchId { count: 2, last: Some(1), .. })
    ));
}

#[test]
fn made_and_strip_are_what_the_last_step_made() {
    let mesh = boxed();
    let made = NewElements {
        vertices: vec![VertexId::new(5), VertexId::new(99)],
        edges: vec![EdgeId::new(4), EdgeId::new(2)],
        strip: vec![EdgeId::new(4)],
        faces: Vec::new(),
    };
    let context = Context { made: Some(&made), ..Context::of(&mesh) };
    assert_eq!(select("made").vertices(&context).expect("one still exists"), [VertexId::new(5)]);
    assert_eq!(select("made").edges(&context).expect("two"), [2, 4].map(EdgeId::new));
    assert_eq!(select("made & !strip").edges(&context).expect("one"), [EdgeId::new(2)]);
    let error = select("made").faces(&context).expect_err("no faces");
    assert_eq!(error.to_string(), "`made` selects no face; the last step made none");
    let error = select("strip").edges(&Context::of(&mesh)).expect_err("no step");
    assert_eq!(
        error.to_string(),
        "`strip` means what the last step made, but no step came before: OBJ files tell it, others do not"
    );
}

#[test]
fn seam_selections_reach_the_seams() {
    let mesh = shape::cube(1.0);
    for (text, folds) in [
        ("matching", seams::Folds::Least),
        ("flattest", seams::Folds::Flattest),
        ("matching:2", seams::Folds::Number(2)),
        ("hamiltonian", seams::Folds::TwoPieces),
    ] {
        match (select(text).edges(&Context::of(&mesh)), seams::folds(&mesh, folds, &Silent)) {
            (Ok(chosen), Ok(folds)) => assert_eq!(chosen.len(), folds.len(), "{text}"),
            (Err(SelectError::Seams { atom, source }), Err(error)) => {
                assert_eq!((atom.as_str(), source), (text, error))
            }
            (chosen, folds) => panic!("{text}: {chosen:?} but {folds:?}"),
        }
    }
}

#[test]
fn an_empty_result_tells_what_there_is() {
    let mesh = boxed();
    let error = |text: &str| select(text).edges(&Context::of(&mesh)).expect_err(text).to_string();
    assert_eq!(error("valence=5"), "`valence=5` selects no edge; the valences are 3 (×8)");
    assert_eq!(
        error("fold>100"),
        "`fold>100deg` selects no edge; the folds go from 90.0000° to 90.0000°"
    );
    assert_eq!(
        error("along=z & above=z:1in"),
        "`along=z:1deg & above=z:25.4mm` selects no edge; the model goes from -10.0000 to 10.0000 \
        mm along z"
    );
    assert_eq!(error("sides=4"), "`sides=4` selects faces, but edges are wanted here");
    let error = select("normal=z").edges(&Context::of(&mesh)).expect_err("no normals").to_string();
    assert_eq!(error, "`normal=z:1deg` selects faces and vertices, but edges are wanted here");
    let error = select("sides=5").faces(&Context::of(&mesh)).expect_err("squares").to_string();
    assert_eq!(error, "`sides=5` selects no face; the faces have sides 4 (×6)");
}

#[test]
fn parse_errors_name_the_column_and_the_nearest_word() {
    for (text, expected) in [
        ("", "the selection is empty; write for example all, valence=4 or 3,7,10-14"),
        ("  ", "the selection is empty; write for example all, valence=4 or 3,7,10-14"),
        ("! valense=3", "`valense` at column 3 is not known; did you mean `valence`?"),
        ("all & colour=3", "`colour` at column 7 is not known; the words are all, valence, sides,"),
        (
            "valence",
            "the selection ends at column 8, but `=`, `!=`, `<`, `<=`, `>` or `>=` was expected",
        ),
        ("along>z", "`>` stands at column 6, but `=` was expected"),
        ("valence=four", "`four` at column 9 is not a whole number; write it like valence=4"),
        ("valence=-1", "`-1` at column 9 is not a whole number"),
        ("valence=", "`` at column 9 is not a whole number"),
        ("fold>3mm", "`3mm` at column 6 is not an angle; write it like fold>30deg"),
        (
            "along=q:5deg",
            "`q:5deg` at column 7 is not a direction and an angle; write it like along=z:5deg",
        ),
        ("along=0,0,0:5deg", "`0,0,0:5deg` at column 7 is not a direction"),
        ("along=z:-5deg", "`z:-5deg` at column 7 is not a direction"),
        ("above=z", "`z` at column 7 is not a direction and a length; write it like above=z:10mm"),
        ("group=", "`` at column 7 is not a name"),
        ("all all", "`a` stands at column 5, but `&`, `|` or the end"),
        ("all &", "the selection ends at column 6, but a condition like all"),
        ("(all", "the selection ends at column 5, but `&`, `|` or `)` was expected"),
        ("all)", "`)` stands at column 4, but `&`, `|` or the end"),
        ("3,,4", "`3,,4` at column 1 is not a list of ids; write it like 3,7,10-14"),
        ("ä & 7-3", "`ä` at column 1 is not known"),
        ("all&7-3", "`7-3` at column 5 is not a list of ids"),
        ("4294967296", "`4294967296` at column 1 is not a list of ids"),
        ("3 x", "`3 x` at column 1 is not a list of ids"),
        ("matching:x", "`x` at column 10 is not a whole number; write it like matching:7"),
    ] {
        let message = message(text);
        assert!(message.starts_with(expected), "{text}: {message}");
    }
    for deep in ["!".repeat(100_000) + "all", "(".repeat(100_000) + "all"] {
        assert!(message(&deep).starts_with("more than 64 brackets"), "{}", &message(&deep)[..80]);
    }
}

#[test]
fn long_chains_do_not_nest() {
    let text = vec!["all"; 100_000].join("|");
    assert_eq!(select(&text).to_string().len(), 100_000 * 3 + 99_999 * 3);
}

#[test]
fn recipes_hold_texts_ids_and_lists() {
    #[derive(Deserialize)]
    struct Step {
        select: Selection,
    }
    let read =
        |value: &str| toml::from_str::<Step>(&format!("select = {value}")).map(|step| step.select);
    for (value, expected) in
        [("\"valence=4\"", "valence=4"), ("7", "7"), ("[3, 7, 10, 11, 12]", "3,7,10-12")]
    {
        assert_eq!(read(value).expect(value), select(expected));
    }
    for bad in ["-1", "[]", "[-3]", "1.5", "true", "5000000000", "\"valense\""] {
        assert!(read(bad).is_err(), "{bad}");
    }
    assert!(
        read("\"valense=3\"").expect_err("a slip").to_string().contains("did you mean `valence`?")
    );
}

fn atoms() -> impl Strategy<Value = String> {
    let sign = prop::sample::select(vec!["=", "!=", "<", "<=", ">", ">="]);
    let axis = prop::sample::select(vec!["x", "-y", "+z", "1,2,-0.5", "0.1,0,1e-7"]);
    let plain = prop::sample::select(vec![
        "all",
        "3,7,10-14",
        "made",
        "strip",
        "matching",
        "flattest",
        "matching:7",
        "hamiltonian",
        "group=a b",
        "group=\"a|b\"",
        "group='say \"a\"'",
    ]);
    prop_oneof![
        plain.prop_map(str::to_owned),
        (prop::sample::select(vec!["valence", "sides"]), sign.clone(), 0_u32..9)
            .prop_map(|(w, s, n)| format!("{w}{s}{n}")),
        (sign, 0.0..180.0).prop_map(|(s, a)| format!("fold {s} {a} deg")),
        (prop::sample::select(vec!["along", "normal"]), axis.clone(), 0.0..90.0)
            .prop_map(|(w, d, a)| format!("{w}={d}:{a}")),
        (prop::sample::select(vec!["above", "below"]), axis, -9.0..9.0)
            .prop_map(|(w, d, l)| format!("{w}={d}:{l}mm")),
    ]
}

proptest! {
    #[test]
    fn written_selections_read_back_the_same(
        text in atoms().prop_recursive(4, 24, 3, |inner| prop_oneof![
            inner.clone().prop_map(|a| format!("!({a})")),
            inner.clone().prop_map(|a| format!("! {a}")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a})&({b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("{a} | {b}")),
            (inner.clone(), inner.clone(), inner).prop_map(|(a, b, c)| format!("{a}&{b} &{c}")),
        ])
    ) {
        let selection = select(&text);
        prop_assert_eq!(&select(&selection.to_string()), &selection, "{} became {}", text, selection);
    }

    #[test]
    fn no_text_panics(text in "[a-z=<>!&|()0-9,:.'\" -]{0,24}") {
        let _ = text.parse::<Selection>();
    }

    #[test]
    fn not_is_the_complement(n in 4_usize..40, seed in 0_u64..1000, sides in 3_u32..8) {
        let mesh = shape::random_tangent_polytope(n, seed);
        let [.., yes] = counts(&mesh, &format!("sides={sides}"));
        let [.., no] = counts(&mesh, &format!("!sides={sides}"));
        prop_assert_eq!(yes + no, n);
    }
}

#[test]
fn the_table_of_conditions_is_what_the_language_does() {
    let mesh = boxed();
    for row in CONDITIONS {
        let selection: Selection =
            row.example.parse().unwrap_or_else(|error| panic!("{}: {error}", row.example));
        let context = Context::of(&mesh);
        let means =
            |error: Option<SelectError>| !matches!(error, Some(SelectError::WrongKind { .. }));
        assert_eq!(
            means(selection.vertices(&context).err()),
            row.vertices != NOTHING,
            "{} of vertices",
            row.example
        );
        assert_eq!(
            means(selection.edges(&context).err()),
            row.edges != NOTHING,
            "{} of edges",
            row.example
        );
        assert_eq!(
            means(selection.faces(&context).err()),
            row.faces != NOTHING,
            "{} of faces",
            row.example
        );
        assert!(row.word.is_empty() || row.example.starts_with(row.word), "{}", row.example);
    }
}
