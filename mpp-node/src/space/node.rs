//! The task with its memory in one value.

use super::{SpaceMemory, SpaceTask};
use mpp_core::map::VoxelGrid;
use mpp_core::planner::space::SpacePlanner;

/// The core in space, for hosts. The value is large: place it in a `static` or a box.
pub struct SpaceNode {
    task: SpaceTask,
    map: VoxelGrid,
    planner: SpacePlanner,
}

impl SpaceNode {
    /// A node that waits for a hello.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            task: SpaceTask::new(),
            map: VoxelGrid::new(),
            planner: SpacePlanner::new(),
        }
    }

    /// Takes bytes from the link. `send` gets each frame of the answer as a whole. When the function returns, the planner has
    /// used all slices granted so far.
    pub fn receive(&mut self, bytes: &[u8], mut send: impl FnMut(&[u8])) {
        let Self { task, map, planner } = self;
        let mut memory = SpaceMemory { map, planner };
        for byte in bytes {
            task.take(*byte, &mut memory, &mut send);
            // The grant of a tick bounds the loop.
            while task.advance(&mut memory) {}
        }
    }

    /// The planner and its map, for inspection between ticks.
    #[must_use]
    pub fn planner(&self) -> Option<(&SpacePlanner, &VoxelGrid)> {
        (self.task.is_configured()).then_some((&self.planner, &self.map))
    }

    /// The tick of the first knot of the plan that is under way, for inspection between ticks.
    #[must_use]
    pub fn begins(&self) -> Option<u32> {
        self.task.begins()
    }

    /// The planner, for a host that compares it with others.
    pub fn planner_mut(&mut self) -> Option<&mut SpacePlanner> {
        (self.task.is_configured()).then_some(&mut self.planner)
    }
}
