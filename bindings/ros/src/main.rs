//! The flight core as a ROS 2 node, without a ROS installation: standard messages in and out over DDS.
//!
//! Odometry is the clock: each message of it does one tick, so that the same messages give the same flight.

mod args;
mod clouds;
mod flight;
mod frames;
mod messages;
mod outputs;
mod pilot;
mod report;
mod scans;
mod settings;
mod told;
mod topics;

use args::{Args, Asked};
use futures::StreamExt;
use futures::executor::block_on;
use futures::future::{Either, select};
use futures::stream::FusedStream;
use pilot::Pilot;
use ros2_client::{
    Context, ContextOptions, MessageInfo, Node, NodeName, NodeOptions, ParameterValue, ReadError,
};
use settings::Settings;
use std::error::Error;
use std::pin::pin;
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use topics::Topics;

const HELP: &str = "\
The MPP flight core as a ROS 2 node: scan, odometry and goal in, plan and setpoint out. docs/ros.md has the topics.

Usage: mpp-ros [--ros-args [-r FROM:=TO]... [-p NAME:=VALUE]...]

  -r FROM:=TO      another name for a topic; __node and __ns for the node
  -p NAME:=VALUE   a parameter (--params-file is not read)
  -h, --help       this text with all parameters
  -V, --version    the version

ROS_DOMAIN_ID is obeyed. The node has no lifecycle services: it does nothing before goal, scan and odometry come, and
stops with the odometry.

Parameters and their values by default:
";

fn main() -> ExitCode {
    match begin() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn begin() -> Result<(), Box<dyn Error>> {
    let args = match Args::parse(std::env::args().skip(1))? {
        Asked::Run(args) => args,
        Asked::Version => {
            println!("mpp-ros {}", env!("CARGO_PKG_VERSION"));
            return Ok(());
        }
        Asked::Help => {
            print!("{HELP}");
            for (name, value) in Settings::of(&[])?.declared() {
                match value {
                    ParameterValue::Double(value) => println!("  {name:<16} {value}"),
                    ParameterValue::String(value) => println!("  {name:<16} {value}"),
                    _ => println!("  {name}"),
                }
            }
            return Ok(());
        }
    };
    let settings = Settings::of(&args.parameters)?;
    let context = Context::with_options(ContextOptions::new().domain_id(domain()?))?;
    run(&context, &args, settings)
}

/// The DDS domain that ROS_DOMAIN_ID names.
fn domain() -> Result<u16, String> {
    let text = std::env::var("ROS_DOMAIN_ID").unwrap_or_default();
    if text.is_empty() {
        return Ok(0);
    }
    let domain = text.parse().ok().filter(|domain| *domain <= 232);
    domain.ok_or_else(|| format!("ROS_DOMAIN_ID is `{text}`: give a number from 0 to 232"))
}

fn run(context: &Context, args: &Args, settings: Settings) -> Result<(), Box<dyn Error>> {
    let (send, changes) = channel();
    // Without settings while the node declares its parameters, each of which counts as a change.
    let known = Arc::new(Mutex::new(None));
    let options = options(&settings, Arc::clone(&known), send);
    let name = NodeName::new(&args.namespace, &args.node)?;
    let mut node: Node = context.new_node(name, options)?;
    *known.lock().unwrap_or_else(PoisonError::into_inner) = Some(settings.clone());
    let topics = Topics::of(&mut node, args)?;
    let spinner = node.spinner()?;
    let mut pilot = Pilot::new(&args.node, settings);
    eprintln!(
        "waits for odometry on {} in domain {}",
        args.topic("odometry"),
        context.domain_id()
    );
    let flying = fly(&topics, &changes, &mut pilot);
    match block_on(select(pin!(spinner.spin()), pin!(flying))) {
        Either::Left((ended, _)) => ended.map_err(Into::into),
        Either::Right(((), _)) => Err("the odometry's subscription has ended".into()),
    }
}

/// The node's options: its parameters, and where changes of them go.
fn options(
    settings: &Settings,
    known: Arc<Mutex<Option<Settings>>>,
    send: Sender<(u8, f64)>,
) -> NodeOptions {
    let declare = |options: NodeOptions, (name, value)| options.declare_parameter(name, value);
    let options = NodeOptions::new().enable_rosout(false);
    let options = settings.declared().into_iter().fold(options, declare);
    options.parameter_set_action(Box::new(move |name, value| {
        let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(settings) = &mut *known {
            // Without a receiver the node is at its end.
            let _ = send.send(settings.change(name, value)?);
        }
        Ok(())
    }))
}

async fn fly(topics: &Topics, changes: &Receiver<(u8, f64)>, pilot: &mut Pilot) {
    let mut odometry = pin!(topics.odometry.async_stream());
    while !odometry.is_terminated() {
        let Some(come) = odometry.next().await else {
            return;
        };
        take(topics, changes, pilot, come);
        for text in pilot.told.fresh() {
            eprintln!("{text}");
        }
    }
}

/// Takes an odometry, and before it all that came with it.
fn take(
    topics: &Topics,
    changes: &Receiver<(u8, f64)>,
    pilot: &mut Pilot,
    come: Result<(messages::Odometry, MessageInfo), ReadError>,
) {
    topics.hear(pilot);
    for (number, value) in changes.try_iter() {
        pilot.hear_parameter(number, value);
    }
    match come {
        Ok((odometry, _)) => {
            for output in pilot.hear_odometry(&odometry) {
                topics.send(output, pilot);
            }
        }
        Err(error) => pilot
            .told
            .tell("odometry", format!("the message is damaged: {error}")),
    }
}
