//! The sizes of the paper's method. The assertions at the end check that they fit together.

/// Greatest length of a ray \[m\].
pub const RAY_LIMIT: f64 = 20.0;
/// Rows (height) of the occupancy grid; a cell is 1 m x 1 m.
pub const GRID_ROWS: usize = 75;
/// Columns (downrange) of the occupancy grid.
pub const GRID_COLS: usize = 150;
/// Row of the aircraft. The aircraft is at the low corner of its cell.
pub const ORIGIN_ROW: usize = 37;
/// Column of the aircraft.
pub const ORIGIN_COL: usize = 25;
/// Rows of the search box: 10 m below to 10 m above the aircraft.
pub const SEARCH_ROWS: usize = 20;
/// First grid row that the path search and the authors' rays see: 10 m below the aircraft.
pub const SEARCH_ROW: usize = 27;
/// Columns of the search box.
pub const SEARCH_COLS: usize = 85;
/// Nodes of one RRT*-AR tree ("a low number of samples", paper, section III-A).
pub const TREE_NODES: usize = 150;
/// Number of samples that one tree may draw, rejected samples included. Recorded runs needed at most 177.
/// The reserve is for fields so dense that the tree rejects most samples.
pub const TREE_SAMPLES: usize = 4 * TREE_NODES;
/// Runs of RRT*-AR in one planning cycle.
pub const TREE_RUNS: usize = 100;
/// Greatest number of points in a path: one for each node of the tree, and the goal.
pub const PATH_POINTS: usize = TREE_NODES + 1;

const _: () = {
    assert!(SEARCH_ROW + SEARCH_ROWS <= GRID_ROWS);
    assert!(SEARCH_COLS <= GRID_COLS);
    assert!(ORIGIN_ROW >= SEARCH_ROW && ORIGIN_ROW < SEARCH_ROW + SEARCH_ROWS);
    assert!(TREE_NODES < u16::MAX as usize);
};
