//! Named values of flags: their help texts and their parsers.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, Command};
use mpp_sim::generator::GeneratorName;
use mpp_sim::names::UnknownName;
use mpp_sim::scenario::{NavigationSource, Preset};
use mpp_sim::scene::Scene;
use mpp_sim::space::lidar::LidarName;
use mpp_sim::space::world::WorldName;
use mpp_sim::space::{BaselineName, ModeName, SPACE};
use std::error::Error;
use std::ffi::OsStr;
use std::fmt::Display;
use std::str::FromStr;
use std::time::Duration;

/// Reads one of these names.
fn named<T>(names: impl IntoIterator<Item = PossibleValue>) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err: Error + Send + Sync> + Clone + Send + Sync + 'static,
{
    PossibleValuesParser::new(names).try_map(|name| name.parse())
}

/// A parser of an item of a list, which may have spaces around it.
#[derive(Clone, Debug)]
pub(super) struct Item<P>(pub(super) P);

impl<P: TypedValueParser> TypedValueParser for Item<P> {
    type Value = P::Value;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<P::Value, clap::Error> {
        let text = value.to_str().map(|text| OsStr::new(text.trim()));
        self.0.parse_ref(command, argument, text.unwrap_or(value))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        self.0.possible_values()
    }
}

/// The values of the cells: those given, or the usual one.
pub(super) fn or_usual(given: &[f64]) -> Vec<Option<f64>> {
    if given.is_empty() {
        return vec![None];
    }
    given.iter().copied().map(Some).collect()
}

/// Reads a number.
pub(super) fn number(text: &str) -> Result<f64, &'static str> {
    text.parse().map_err(|_| "give a number, such as 1.5")
}

/// Reads a whole number that is not negative.
pub(super) fn whole<T>() -> impl TypedValueParser<Value = T>
where
    T: FromStr + Clone + Send + Sync + 'static,
{
    |text: &str| {
        text.parse::<T>().map_err(|_| match text.parse::<u64>() {
            Ok(_) => "give a smaller number",
            Err(_) => "give a whole number of 0 or more",
        })
    }
}

/// Reads a whole number in a range.
pub(super) fn within<T>(least: T, most: T) -> impl TypedValueParser<Value = T>
where
    T: FromStr + PartialOrd + Display + Copy + Send + Sync + 'static,
{
    move |text: &str| {
        let found = text.parse().ok().filter(|it| (least..=most).contains(it));
        found.ok_or_else(|| format!("give a whole number from {least} to {most}"))
    }
}

/// Reads HOST:PORT.
pub(super) fn place(text: &str) -> Result<String, String> {
    let host = |host: &str| {
        let bracketed = host.starts_with('[') && host.ends_with(']');
        !host.is_empty() && (bracketed || !host.contains(':'))
    };
    let parts = text.rsplit_once(':');
    let sound = parts.is_some_and(|(name, port)| host(name) && port.parse::<u16>().is_ok());
    let advice = || "give HOST:PORT, such as 127.0.0.1:8088".to_owned();
    sound.then(|| text.to_owned()).ok_or_else(advice)
}

/// Reads udp:HOST:PORT, or `usual` for the usual addresses.
pub(super) fn datagrams(text: &str) -> Result<String, String> {
    let text = text.trim();
    let sound = text == "usual"
        || text
            .strip_prefix("udp:")
            .is_some_and(|it| place(it).is_ok());
    let advice = || "give udp:HOST:PORT, such as udp:127.0.0.1:14550".to_owned();
    sound.then(|| text.to_owned()).ok_or_else(advice)
}

/// Most threads that a command starts. Each has a stack of 8 MB.
const MOST_THREADS: usize = 1024;

/// Reads a number of threads.
pub(super) fn threads() -> impl TypedValueParser<Value = usize> {
    within(0, MOST_THREADS)
}

/// Reads a seed.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    let advice = format!("a seed is a whole number from 0 to {}", u64::MAX);
    text.parse().map_err(|_| advice)
}

/// Reads the width of an interval [percentage points].
pub(super) fn width(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|it| *it > 0.0 && *it <= 100.0);
    found.ok_or_else(|| "give a width of more than 0 and at most 100 percentage points".to_owned())
}

/// Reads a sight \[m\].
pub(super) fn sight(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|it| *it > 0.0 && *it <= 1000.0);
    found.ok_or_else(|| "give a sight of more than 0 and at most 1000 m".to_owned())
}

/// Reads a bank \[deg\].
pub(super) fn bank(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|it| (-60.0..=60.0).contains(it));
    found.ok_or_else(|| "give -60 to 60 deg".to_owned())
}

/// Reads a wind on three axes [m/s].
pub(super) fn wind(text: &str) -> Result<[f64; 3], String> {
    let parts: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let found = parts
        .ok()
        .and_then(|parts| <[f64; 3]>::try_from(parts).ok());
    let weak = found.filter(|wind| wind.iter().all(|it| it.abs() <= 30.0));
    weak.ok_or_else(|| "give X,Y,Z, three speeds of at most 30 m/s".to_owned())
}

/// Reads a time to wait \[s\].
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let found = text
        .parse()
        .ok()
        .filter(|seconds| (0.001..=1e6).contains(seconds));
    let advice = || "give 0.001 to 1000000 seconds".to_owned();
    found.map(Duration::from_secs_f64).ok_or_else(advice)
}

/// Reads a preset.
pub(super) fn preset() -> impl TypedValueParser<Value = Preset> {
    let help = |preset| match preset {
        Preset::Reference => "The rules of the authors' code, with its faults, to compare with it",
        Preset::Paper => "The paper's text, with its slips corrected",
        Preset::Flight => "The best parameters and rules that we know",
    };
    // The command line of this preset is another one, which is chosen before flags are read.
    let space = PossibleValue::new(SPACE).help("The planner in space: it has other flags");
    let here = Preset::ALL.map(|preset| PossibleValue::new(preset.name()).help(help(preset)));
    PossibleValuesParser::new(here.into_iter().chain([space])).try_map(|name| {
        let other = "give `--preset space` alone, after fly or campaign";
        name.parse().map_err(|_: UnknownName| other)
    })
}

/// Reads a navigation source.
pub(super) fn navigation() -> impl TypedValueParser<Value = NavigationSource> {
    let help = |source| match source {
        NavigationSource::Ideal => "The true position, 100 Hz",
        NavigationSource::Rtk => "10 Hz, 0.02 m white, 0.05 m wandering, 50 ms late",
        NavigationSource::GnssIns => {
            "10 Hz, 0.1 m white, 0.5 m wandering, 100 ms late, with velocities"
        }
        NavigationSource::LidarOdometry => "20 Hz, 0.03 m white, drift of 1 % of the way",
    };
    named(NavigationSource::ALL.map(|source| PossibleValue::new(source.name()).help(help(source))))
}

/// Reads a generator of random obstacles.
pub(super) fn generator() -> impl TypedValueParser<Value = GeneratorName> {
    let help = |name| match name {
        GeneratorName::Paper => "Circles, evenly spaced, within 10 m of the altitude",
        GeneratorName::Sealed => "The same within 12 m: no free lane runs along the band",
        GeneratorName::Endless => "Circles at random places, as far as the flight goes",
        GeneratorName::Forest => "Circles of many sizes in clusters",
        GeneratorName::Canyon => "A winding way between ground and ceiling",
        GeneratorName::Slalom => "Walls from above and below in turn",
        GeneratorName::Walls => "Walls across the band, each with one gap",
        GeneratorName::Wires => "Thin circles, or thin bars",
    };
    named(GeneratorName::ALL.map(|name| PossibleValue::new(name.name()).help(help(name))))
}

/// Reads a generator of a world in space.
pub(super) fn world() -> impl TypedValueParser<Value = WorldName> {
    let help = |name| match name {
        WorldName::Forest => "Trunks at places that know nothing of each other",
        WorldName::Grid => "Trunks in a grid, each moved by at most half of the spacing",
        WorldName::Disc => "Trunks with a least distance from each other",
        WorldName::Spheres => "Spheres of 1 m radius",
        WorldName::Walls => "Walls across the way, each with one square window",
        WorldName::Slalom => "Rows of trunks from both sides in turn",
        WorldName::Hills => "Hills over level ground, as steep as the density says",
    };
    named(WorldName::ALL.map(|name| PossibleValue::new(name.name()).help(help(name))))
}

/// Reads a lidar in space.
pub(super) fn lidar() -> impl TypedValueParser<Value = LidarName> {
    named(LidarName::ALL.map(|name| PossibleValue::new(name.name())))
}

/// Reads a planner in place of ours.
pub(super) fn baseline() -> impl TypedValueParser<Value = BaselineName> {
    let help = |name| match name {
        BaselineName::Straight => "Straight on",
        BaselineName::Library7 => "Seven manoeuvres by the rule of Barry, Florence and Tedrake",
        BaselineName::Library105 => "105 primitives with the price and the cost-to-go of our plans",
        BaselineName::Paper => "The paper's trees, rays and programs, with a third dimension",
    };
    named(BaselineName::ALL.map(|name| PossibleValue::new(name.name()).help(help(name))))
}

/// Reads a mode.
pub(super) fn mode() -> impl TypedValueParser<Value = ModeName> {
    let help = |name| match name {
        ModeName::Forest => "It is flown",
        ModeName::Open => "The plan before goes on to a circle; a drawn world is 120 m wide",
    };
    named(ModeName::ALL.map(|name| PossibleValue::new(name.name()).help(help(name))))
}

/// Reads a challenge scene.
pub(super) fn scene() -> impl TypedValueParser<Value = Scene> {
    let help = |scene| match scene {
        Scene::Flytrap => {
            "A bowl of 5 m radius that opens towards the aircraft. Inside the bowl, the way to the \
             goal leads into the wall. The ways round pass above and below"
        }
        Scene::Dynamics => {
            "A plate, 9 m high, at a right angle to the way. Every normal of its face points \
             straight against the flight, which cannot slow down. The ways round pass above and below"
        }
        Scene::LongWay => {
            "A wall that leans towards the aircraft. It reaches from 4 m on one side of the way to \
             15 m on the other; the seed decides which side is up. Its face leads along the long way \
             round, out of the band. The short way passes over its near edge"
        }
    };
    named(Scene::ALL.map(|scene| PossibleValue::new(scene.name()).help(help(scene))))
}
