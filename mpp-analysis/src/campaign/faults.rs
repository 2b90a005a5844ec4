//! A campaign of faults: for each named fault the same fields are flown without and with it.
//!
//! The flights without a fault are flown once for each cell. All faults share them.

use super::grid::{Campaign, Cell, Lists};
use mpp_sim::names::UnknownName;
use mpp_sim::scenario::{Scenario, ScenarioError, ScenarioFile};
use mpp_sim::scene::Scene;

/// A fault with a name, as a scenario file that goes over the campaign's scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedFault {
    /// Its name.
    pub name: &'static str,
    /// The text of its file.
    pub text: &'static str,
    /// The most points of success that it may cost [percentage points]; `None` if nothing is asked.
    pub asked: Option<f64>,
}

/// Makes the table of the faults from their names and what is asked of them.
macro_rules! named {
    ($($name:literal: $asked:expr,)*) => {
        &[$(NamedFault {
            name: $name,
            text: include_str!(concat!("../../faults/", $name, ".toml")),
            asked: $asked,
        }),*]
    };
}

impl NamedFault {
    /// All of them, in the order of the report. The files are in `docs/scenarios/faults`.
    pub const ALL: &'static [Self] = named! {
        "rtk": Some(1.0),
        "gnss-ins": Some(2.0),
        "lidar-odometry": Some(2.0),
        "airspeed-frozen": Some(2.0),
        "pitch-frozen": Some(2.0),
        "both-frozen": Some(5.0),
        "pitch-stuck": Some(1.0),
        "pitch-stuck-drift": Some(1.0),
        "pitch-stuck-3s": Some(1.0),
        "pitch-toggling": Some(2.0),
        "pitch-bias": Some(3.0),
        "airspeed-bias": Some(3.0),
        "airspeed-bias-low": Some(3.0),
        "airspeed-pitch-bias": Some(3.0),
        "airspeed-pitch-bias-high": Some(3.0),
        "airspeed-ramp": Some(3.0),
        "airspeed-ramp-low": Some(3.0),
        "pitot-blocked": Some(3.0),
        "air-delay": Some(3.0),
        "scan-delay": Some(3.0),
        "position-delay": Some(3.0),
        "scan-stale": Some(3.0),
        "lidar-zeros": Some(3.0),
        "lidar-full-range": Some(3.0),
        "lidar-frozen": Some(3.0),
        "lidar-silent": Some(3.0),
        "lidar-half": Some(5.0),
        "lidar-fog": Some(5.0),
        "lidar-reversed": None,
        "lidar-aged": Some(5.0),
        "link-silent-1s": Some(1.0),
        "link-silent-3s": Some(5.0),
        "link-loss-20": Some(1.0),
        "link-loss-50": Some(10.0),
        "clock-jump-1s": Some(2.0),
        "clock-jump-10s": Some(2.0),
        "clock-jump-100s": Some(2.0),
        "clock-back": Some(2.0),
        "clock-wrap": Some(2.0),
        "latency-250ms": Some(2.0),
        "latency-500ms": Some(5.0),
        "elevator-rate-120": None,
        "elevator-rate-160": None,
        "elevator-stuck-1s": Some(2.0),
        "elevator-quarter": Some(5.0),
        "elevator-stuck": None,
        "thrust-lost-3s": Some(5.0),
        "thrust-lost": None,
        "position-jump": Some(3.0),
        "position-step": Some(3.0),
        "position-noise-0.1": None,
    };

    /// The faults with these names, in the order of the names. The name `all` stands for all of them.
    ///
    /// # Errors
    /// [`UnknownName`].
    pub fn of(names: &[String]) -> Result<Vec<Self>, UnknownName> {
        let mut found: Vec<Self> = Vec::new();
        for name in names {
            let these = |fault: &&Self| name == "all" || fault.name == name;
            let known = found.len();
            let named = Self::ALL.iter().filter(these);
            let mut any = false;
            for fault in named {
                any = true;
                if !found[..known].contains(fault) {
                    found.push(*fault);
                }
            }
            if !any {
                let known = core::iter::once("all").chain(Self::ALL.iter().map(|fault| fault.name));
                return Err(UnknownName {
                    kind: "fault",
                    name: name.clone(),
                    known: known.collect(),
                });
            }
        }
        Ok(found)
    }
}

/// One fault of a campaign.
#[derive(Clone, Debug)]
pub(super) struct Variant {
    pub(super) fault: NamedFault,
    /// The campaign with the fault; only its scenario and its seeds count.
    campaign: Campaign,
    /// The cells of the pairs.
    pub(super) cells: Vec<Cell>,
}

/// One flight of a campaign of faults.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultJob {
    /// Number of the fault in the campaign; `None` without a fault.
    pub(super) fault: Option<usize>,
    /// Cell of the flight.
    pub cell: Cell,
    /// Seed of the flight.
    pub seed: u64,
}

/// The pairs of flights of a campaign of faults.
#[derive(Clone, Debug)]
pub struct FaultCampaign {
    clean: Campaign,
    pub(super) faults: Vec<Variant>,
}

/// Obstacles and replanning rate \[Hz\] of the pairs if neither lists nor scenario say what is flown through.
const DEFAULT_PAIRS: [(usize, f64); 2] = [(20, 1.0), (40, 4.0)];

impl FaultCampaign {
    /// The scene in every field.
    pub(super) fn scene(&self) -> Option<Scene> {
        self.clean.scenario.scene
    }

    /// A campaign with `trials` pairs for each fault and cell. The cells are those of lists and scenario. If these
    /// name no obstacles, no rate, no scene and no field, the cells are 20 obstacles at 1 Hz and 40 obstacles at
    /// 4 Hz. A fault whose file names obstacles or a rate has these in each cell.
    ///
    /// # Errors
    /// [`ScenarioError`] when the scenario, a fault or a cell is invalid.
    pub fn new(
        scenario: &ScenarioFile,
        lists: &Lists,
        trials: u32,
        seed: Option<u64>,
        faults: &[NamedFault],
    ) -> Result<Self, ScenarioError> {
        let (clean, cells) = cells_of(scenario, lists, trials, seed)?;
        let variant = |fault: &NamedFault| -> Result<Variant, ScenarioError> {
            let name = format!("docs/scenarios/faults/{}.toml", fault.name);
            let own = ScenarioFile::parse(&name, fault.text)?;
            let mut paired: Vec<Cell> = Vec::new();
            for cell in &cells {
                let cell = Cell {
                    obstacles: own.obstacles.unwrap_or(cell.obstacles),
                    replan_hz: own.replan_hz.unwrap_or(cell.replan_hz),
                    ..cell.clone()
                };
                if !paired.contains(&cell) {
                    paired.push(cell);
                }
            }
            let variant = Variant {
                fault: *fault,
                campaign: Campaign {
                    scenario: clean.scenario.under(&name, fault.text)?,
                    ..clean.clone()
                },
                cells: paired,
            };
            for cell in &variant.cells {
                clean.scenario(cell, clean.seed)?;
                let faulty = variant.campaign.scenario(cell, clean.seed);
                faulty.map_err(|error| ScenarioError::File(name.clone(), Box::new(error)))?;
            }
            Ok(variant)
        };
        let faults = faults.iter().map(variant).collect::<Result<_, _>>()?;
        Ok(Self { clean, faults })
    }

    /// Every flight: those without a fault first, each of them once. If the campaign has an oracle, it flies with
    /// the faults.
    #[must_use]
    pub fn jobs(&self) -> Vec<FaultJob> {
        let mut clean: Vec<(Option<usize>, Cell)> = Vec::new();
        let mut faulty = Vec::new();
        for (number, variant) in self.faults.iter().enumerate() {
            for cell in &variant.cells {
                if !clean.contains(&(None, cell.clone())) {
                    clean.push((None, cell.clone()));
                }
                faulty.push((Some(number), cell.clone()));
                let oracle = self.oracle_beside(cell);
                faulty.extend(oracle.map(|oracle| (Some(number), oracle)));
            }
        }
        let all = clean.into_iter().chain(faulty);
        let job = |fault, cell: &Cell, seed| FaultJob {
            fault,
            cell: cell.clone(),
            seed,
        };
        all.flat_map(|(fault, cell)| self.seeds().map(move |seed| job(fault, &cell, seed)))
            .collect()
    }

    /// The cell of the oracle's flights with a fault beside those of a cell, if the campaign has an oracle.
    pub(super) fn oracle_beside(&self, cell: &Cell) -> Option<Cell> {
        self.clean.oracle_beside(cell)
    }

    /// The seeds of the pairs.
    fn seeds(&self) -> impl Iterator<Item = u64> + use<> {
        let first = self.clean.seed;
        (0..u64::from(self.clean.trials)).map(move |trial| first.wrapping_add(trial))
    }

    /// The scenario of a flight.
    ///
    /// # Errors
    /// [`ScenarioError`].
    pub fn scenario(&self, job: &FaultJob) -> Result<Scenario, ScenarioError> {
        let variant = job.fault.and_then(|number| self.faults.get(number));
        let campaign = variant.map_or(&self.clean, |variant| &variant.campaign);
        campaign.scenario(&job.cell, job.seed)
    }

    /// The name of a flight's fault, if it has one.
    #[must_use]
    pub fn name(&self, job: &FaultJob) -> Option<&'static str> {
        let variant = job.fault.and_then(|number| self.faults.get(number));
        variant.map(|variant| variant.fault.name)
    }
}

/// The campaign without a fault, and the cells of lists and scenario, or 20 obstacles at 1 Hz and 40 at 4 Hz.
pub(super) fn cells_of(
    scenario: &ScenarioFile,
    lists: &Lists,
    trials: u32,
    seed: Option<u64>,
) -> Result<(Campaign, Vec<Cell>), ScenarioError> {
    let given = says_what_is_flown(scenario, lists);
    let clean = Campaign::new(scenario.clone(), lists.clone(), trials, seed)?;
    let mut cells = clean.cells();
    cells.retain(|cell| !cell.oracle);
    if !given {
        let paired = |cell: &Cell| {
            DEFAULT_PAIRS.map(|(obstacles, replan_hz)| Cell {
                obstacles,
                replan_hz,
                ..cell.clone()
            })
        };
        cells = cells.iter().flat_map(paired).collect();
    }
    Ok((clean, cells))
}

/// Whether lists or scenario name what is flown through, or how often it is planned.
fn says_what_is_flown(scenario: &ScenarioFile, lists: &Lists) -> bool {
    let listed = !(lists.obstacles.is_empty() && lists.replan_hz.is_empty());
    let placed = !(lists.field.is_empty() && scenario.field.is_empty());
    let named = scenario.obstacles.is_some() || scenario.replan_hz.is_some();
    listed || placed || named || scenario.scene.is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::NamedField;
    use mpp_sim::field::FieldFile;

    fn campaign(names: &[&str], lists: &Lists) -> FaultCampaign {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let faults = NamedFault::of(&names).unwrap();
        FaultCampaign::new(&ScenarioFile::default(), lists, 3, Some(5), &faults).unwrap()
    }

    #[test]
    fn every_named_fault_is_a_fault_that_can_be_flown() {
        let all = campaign(&["all"], &Lists::default());
        assert_eq!(all.faults.len(), NamedFault::ALL.len());
        for variant in &all.faults {
            let job = |fault| FaultJob {
                fault,
                cell: variant.cells[0].clone(),
                seed: 5,
            };
            let number = all.faults.iter().position(|one| one.fault == variant.fault);
            let (clean, faulty) = (all.scenario(&job(None)), all.scenario(&job(number)));
            let (clean, faulty) = (clean.unwrap(), faulty.unwrap());
            // The source of fault `rtk` is the one that preset `flight` has without a fault.
            let same = variant.fault.name == "rtk";
            assert_eq!(clean == faulty, same, "{}", variant.fault.name);
            assert_eq!(clean.field(), faulty.field(), "{}", variant.fault.name);
        }
    }

    #[test]
    fn faults_share_the_flights_without_a_fault() {
        let two = campaign(&["rtk", "pitch-bias", "rtk"], &Lists::default());
        let jobs = two.jobs();
        let clean = jobs.iter().filter(|job| job.fault.is_none()).count();
        // Two cells with three seeds each.
        assert_eq!((clean, jobs.len()), (6, 18));
        let own = campaign(&["latency-500ms"], &Lists::default()).jobs();
        let cells: Vec<_> = own
            .iter()
            .map(|job| (job.cell.obstacles, job.cell.replan_hz))
            .collect();
        assert_eq!(cells[0], (20, 2.0));
        assert_eq!(cells[11], (40, 2.0));
        let lists = Lists {
            obstacles: vec![10, 30],
            ..Lists::default()
        };
        let dense = campaign(&["elevator-rate-160"], &lists).jobs();
        assert_eq!(dense.len(), 6);
        assert!(dense.iter().all(|job| job.cell.obstacles == 160));
    }

    #[test]
    fn the_cells_are_those_of_the_scenario_and_a_scene_or_a_field_stands_alone() {
        let cells = |scenario: &str, lists: &Lists| -> Vec<(usize, f64)> {
            let scenario = ScenarioFile::parse("", scenario).unwrap();
            let faults = NamedFault::of(&["pitch-bias".to_owned()]).unwrap();
            let campaign = FaultCampaign::new(&scenario, lists, 1, None, &faults).unwrap();
            let cells = campaign.faults[0].cells.iter();
            cells.map(|cell| (cell.obstacles, cell.replan_hz)).collect()
        };
        let circle = "circle]]\nx = 120.0\nz = 50.0\nradius = 2.0";
        let none = Lists::default();
        assert_eq!(cells("seed = 3", &none), DEFAULT_PAIRS);
        assert_eq!(cells("obstacles = 7", &none), [(7, 1.0)]);
        assert_eq!(cells("replan_hz = 2.0", &none), [(20, 2.0)]);
        assert_eq!(cells("scene = \"flytrap\"", &none), [(0, 1.0)]);
        assert_eq!(cells(&format!("[[field.{circle}"), &none), [(0, 1.0)]);
        let content = FieldFile::parse("a.toml", &format!("[[{circle}")).unwrap();
        let name = "a.toml".to_owned();
        let field = Lists {
            field: vec![NamedField { name, content }],
            ..Lists::default()
        };
        assert_eq!(cells("", &field), [(0, 1.0)]);
        let both = Lists {
            obstacles: vec![5],
            ..field
        };
        assert_eq!(cells("obstacles = 7", &both), [(5, 1.0)]);
    }

    #[test]
    fn a_fault_that_the_flight_does_not_reach_is_named() {
        let scenario = ScenarioFile::parse("", "duration = 4").unwrap();
        let faults = NamedFault::of(&["lidar-zeros".to_owned()]).unwrap();
        let error = FaultCampaign::new(&scenario, &Lists::default(), 1, None, &faults).unwrap_err();
        let expected = "docs/scenarios/faults/lidar-zeros.toml: faults.scan: it begins after";
        assert!(error.to_string().starts_with(expected), "{error}");
    }

    #[test]
    fn an_unknown_fault_is_refused_with_the_known_ones() {
        let error = NamedFault::of(&["rtx".to_owned()]).unwrap_err().to_string();
        assert!(
            error.starts_with("there is no fault `rtx`: give all, rtk, "),
            "{error}"
        );
    }
}
