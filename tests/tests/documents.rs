//! Whether the documents say what the code says: links, names in links, and the numbers of the planner.

#![expect(
    clippy::panic,
    clippy::unwrap_used,
    reason = "the helpers of tests fail as tests do"
)]

use mpp_core::control::LqrWeights;
use mpp_core::estimate::EkfTuning;
use mpp_core::qp::{Penalty, Weights};
use mpp_core::settings::{AttitudeLimits, Cruise, PlaneSettings, PlannerSettings, Settings};
use mpp_core::units::Units;
use mpp_core::vehicle::{Airframe, Trim};
use mpp_tests::project::{files, root};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use syn::{BinOp, Expr, Item, Lit};

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// README, ARCHITECTURE, CONTRIBUTING, and every page below `docs`.
fn pages() -> Vec<PathBuf> {
    let pages = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(|page| root().join(page));
    [&pages[..], &files(&root().join("docs"), "md")].concat()
}

/// Text and target of each link of a page; what stands in a block of code is none.
fn links(page: &str) -> Vec<(&str, &str)> {
    let outside = page.split("\n```").step_by(2);
    outside
        .flat_map(|part| part.match_indices("](").map(move |(at, _)| (part, at)))
        .filter_map(|(part, at)| {
            let text = part[..at].rsplit_once('[')?.1;
            let target = part[at + 2..].split_once(')')?.0;
            Some((text, target))
        })
        .collect()
}

/// The anchor of a heading: small letters, no marks, bars for spaces.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    text.chars()
        .filter(kept)
        .collect::<String>()
        .replace(' ', "-")
}

/// What is wrong with a link of a page, if anything.
///
/// A target is a file or folder, and perhaps a heading of a page. Where the text is a name or a line of code and the target is a source
/// file, the file holds it: who renames a function finds the page that speaks of it.
fn fault(page: &Path, text: &str, target: &str) -> Option<String> {
    if target.contains("://") {
        return None;
    }
    let (file, wanted) = target.split_once('#').unwrap_or((target, ""));
    let path = match file {
        "" => page.to_owned(),
        file => page.parent()?.join(file),
    };
    if !path.exists() {
        return Some(format!("there is no {target}"));
    }
    if !wanted.is_empty() {
        let is_there = read(&path)
            .lines()
            .any(|line| line.starts_with('#') && anchor(line) == wanted);
        return (!is_there).then(|| format!("there is no heading {target}"));
    }
    // In a table a bar is escaped.
    let code = text
        .strip_prefix('`')?
        .strip_suffix('`')?
        .replace("\\|", "|");
    let is_source = path.extension().is_some_and(|extension| extension == "rs");
    let is_name = code
        .chars()
        .all(|c| c.is_alphanumeric() || "_:".contains(c));
    let is_line = code.contains(' ') || code.contains('(');
    if !is_source || !(is_name || is_line) || path.file_stem().is_some_and(|stem| stem == &code[..])
    {
        return None;
    }
    let sought = if is_line {
        &code
    } else {
        code.rsplit("::").next()?
    };
    let found = read(&path).contains(sought);
    (!found).then(|| format!("{target} holds no `{sought}`"))
}

#[test]
fn every_link_leads_to_a_file_that_holds_what_it_names() {
    let mut faults = Vec::new();
    for page in pages() {
        let text = read(&page);
        let links = links(&text).into_iter();
        let found = links.filter_map(|(text, target)| fault(&page, text, target));
        faults.extend(found.map(|fault| format!("{}: {fault}", page.display())));
    }
    assert_eq!(faults, Vec::<String>::new());
}

#[test]
fn a_dead_link_and_a_name_that_is_gone_are_found() {
    let readme = root().join("README.md");
    assert_eq!(fault(&readme, "Fly", "#fly"), None);
    assert!(fault(&readme, "Fly", "#no-such-heading").is_some());
    let page =
        "[a](b.md) [`x`](tests/src/lib.rs)\n```\n[c](d.md)\n```\n[`golden`](tests/src/lib.rs)";
    let faults: Vec<_> = links(page)
        .into_iter()
        .map(|(text, target)| fault(&readme, text, target))
        .collect();
    assert_eq!(faults.len(), 3);
    assert_eq!(faults[0].as_deref(), Some("there is no b.md"));
    assert!(fault(&readme, "`no_such_name`", "tests/src/lib.rs").is_some());
    assert!(fault(&readme, "`let no = line();`", "tests/src/lib.rs").is_some());
    assert_eq!(faults[2], None);
}

/// Values of the constants of a file, those of a module inside it as `module::NAME`.
fn constants(source: &str) -> BTreeMap<String, f64> {
    let file = syn::parse_file(source).unwrap();
    let mut found = BTreeMap::new();
    collect("", &file.items, &mut found);
    found
}

fn collect(prefix: &str, items: &[Item], found: &mut BTreeMap<String, f64>) {
    for item in items {
        match item {
            Item::Const(constant) => {
                if let Some(value) = value(&constant.expr, found) {
                    found.insert(format!("{prefix}{}", constant.ident), value);
                }
            }
            Item::Mod(module) => {
                if let Some((_, items)) = &module.content {
                    collect(&format!("{prefix}{}::", module.ident), items, found);
                }
            }
            _ => {}
        }
    }
}

/// The value of a number, or of a few with signs between them.
fn value(expression: &Expr, known: &BTreeMap<String, f64>) -> Option<f64> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Float(number) => number.base10_parse().ok(),
            Lit::Int(number) => number.base10_parse().ok(),
            _ => None,
        },
        Expr::Paren(inner) => value(&inner.expr, known),
        Expr::Path(path) => known.get(&path.path.get_ident()?.to_string()).copied(),
        Expr::Binary(binary) => {
            let (left, right) = (value(&binary.left, known)?, value(&binary.right, known)?);
            match binary.op {
                BinOp::Add(_) => Some(left + right),
                BinOp::Mul(_) => Some(left * right),
                BinOp::Div(_) => Some(left / right),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Name, value and whole line of each row of a section of docs/planner-numbers.md.
fn rows(section: &str) -> Vec<(String, f64, String)> {
    let page = read(&root().join("docs/planner-numbers.md"));
    let start = page
        .find(section)
        .unwrap_or_else(|| panic!("there is no {section}"));
    let body = &page[start + section.len()..];
    let body = body.split("\n## ").next().unwrap_or(body);
    let rows: Vec<_> = body
        .lines()
        .filter_map(|line| {
            let mut cells = line.strip_prefix("| `")?.split('|').map(str::trim);
            let name = cells.next()?.trim_end_matches('`');
            let number = syn::parse_str(cells.next()?).unwrap();
            let number = value(&number, &BTreeMap::new()).unwrap();
            Some((name.to_owned(), number, line.to_owned()))
        })
        .collect();
    assert!(!rows.is_empty(), "{section} has no rows");
    rows
}

/// What a table says, by name.
fn table(section: &str) -> BTreeMap<String, f64> {
    let rows = rows(section);
    let count = rows.len();
    let table: BTreeMap<_, _> = rows
        .into_iter()
        .map(|(name, number, _)| (name, number))
        .collect();
    assert_eq!(table.len(), count, "{section}: a name stands there twice");
    table
}

#[test]
fn the_table_of_tuned_numbers_is_that_of_the_code() {
    let mut numbers = BTreeMap::new();
    for file in ["tuning.rs", "tuning/watches.rs"] {
        let source = read(&root().join("mpp-core/src").join(file));
        let found = constants(&source);
        // Each constant of the file has a value that this test can read.
        let all = source.matches("pub const ").count();
        assert_eq!(found.len(), all, "{file}");
        assert_eq!(source.matches("Source: ").count(), all, "sources in {file}");
        numbers.extend(found);
    }
    assert_eq!(table("## Tuned numbers"), numbers);
}

#[test]
fn the_table_of_sizes_is_that_of_the_code() {
    for (name, number, line) in rows("## Sizes and rates") {
        let links = links(&line);
        let (_, target) = links.last().unwrap_or_else(|| panic!("{name} has no link"));
        let known = constants(&read(&root().join("docs").join(target)));
        assert_eq!(known.get(&name), Some(&number), "{name} of {target}");
    }
}

#[test]
fn the_table_of_settings_is_that_of_preset_flight() {
    // Whoever adds a field has to say here, and in the table, what it is.
    let Settings {
        units: Units::SI,
        airframe: Airframe::REFERENCE,
        actuators: _,
        cruise: Cruise::Airspeed(cruise),
        design_thrust: None,
        design_jacobian: _,
        estimator,
        wind_change: Some(wind_change),
        regulator,
        cross_track,
        airspeed_hold,
        planner,
    } = Settings::flight()
    else {
        panic!("preset flight has other settings than the table says");
    };
    let EkfTuning {
        process_noise,
        airspeed_variance,
        pitch_variance,
        initial_variance,
        gate,
        jacobian: _,
    } = estimator;
    let LqrWeights { state, elevator } = regulator;
    let own = *planner.plane().unwrap();
    let PlannerSettings {
        paths,
        altitude,
        seed: 0,
        weights: Weights { control, terminal },
        method: _,
    } = planner
    else {
        panic!("preset flight has another seed than the table says");
    };
    let PlaneSettings {
        sight,
        latency,
        penalty: Penalty { linear, quadratic },
        stall: _,
        body_radius: _,
        attitude: AttitudeLimits {
            angle_of_attack,
            flight_path,
        },
        sqp_iterations,
        refined_candidates,
        margin,
        band,
        thrust_max,
    } = own;
    // A standard deviation of a quarter of a degree.
    assert!((pitch_variance.sqrt() - 0.25_f64.to_radians()).abs() < 1e-15);
    let settings: [(&str, f64); 32] = [
        ("cruise", cruise),
        ("wind_change", wind_change),
        ("cross_track", cross_track),
        ("airspeed_hold", airspeed_hold),
        ("estimator.process_noise[0]", process_noise[0]),
        ("estimator.process_noise[1]", process_noise[1]),
        ("estimator.process_noise[2]", process_noise[2]),
        ("estimator.process_noise[3]", process_noise[3]),
        ("estimator.airspeed_variance", airspeed_variance),
        ("estimator.initial_variance", initial_variance),
        ("estimator.gate", gate),
        ("regulator.state[0]", state[0]),
        ("regulator.state[1]", state[1]),
        ("regulator.state[2]", state[2]),
        ("regulator.state[3]", state[3]),
        ("regulator.elevator", elevator),
        ("planner.paths", paths as f64),
        ("planner.altitude", altitude),
        ("planner.weights.control[0]", control[0]),
        ("planner.weights.control[1]", control[1]),
        ("planner.weights.terminal", terminal),
        ("sight", sight),
        ("latency", latency),
        ("penalty.linear", linear),
        ("penalty.quadratic", quadratic),
        ("attitude.angle_of_attack", angle_of_attack),
        ("attitude.flight_path", flight_path),
        ("sqp_iterations", f64::from(sqp_iterations)),
        ("refined_candidates", refined_candidates as f64),
        ("margin", margin),
        ("band", band),
        ("thrust_max", thrust_max),
    ];
    let settings = settings.map(|(name, value)| (name.to_owned(), value));
    assert_eq!(
        table("## Settings of preset `flight`"),
        BTreeMap::from(settings)
    );
}

/// The pages give the elevator of level trim by airframe and cruise.
#[test]
fn the_elevator_of_level_trim_is_what_the_pages_say() {
    let elevator = |airframe| {
        Trim::at_speed(airframe, 12.0, 0.0)
            .unwrap()
            .control
            .elevator
    };
    let authors = Trim::of_authors(&Airframe::REFERENCE).control.elevator;
    let told = [
        elevator(&Airframe::REFERENCE),
        elevator(&Airframe::PAPER),
        authors,
    ];
    let [reference, paper, authors] = told.map(|elevator| format!("{elevator:.3}"));
    for page in [
        "docs/notation.md",
        "docs/planner.md",
        "docs/scenarios/example.toml",
        "mpp-core/src/vehicle/airframe.rs",
    ] {
        assert!(
            read(&root().join(page)).contains(&reference),
            "{page}: {reference}"
        );
    }
    let notation = read(&root().join("docs/notation.md"));
    assert!(
        notation.contains(&paper) && notation.contains(&authors),
        "{paper}, {authors}"
    );
}
