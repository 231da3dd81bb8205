//! The order of the finite differences in space.

/// Order of the finite differences in space; in time they are of second order always.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub enum Order {
    /// The Yee scheme, gprMax's.
    #[default]
    Second,
    /// FDTD(2,4): `d = 9/8 (f₁ - f₀) - 1/24 (f₂ - f₋₁)` (Fang 1989; Taflove & Hagness 2005, section 4.9.2).
    Fourth,
}

/// An order that is neither 2 nor 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("there is no scheme of order {0}\n\nhint: 2 (as gprMax) or 4")]
pub struct NoSuchOrder(
    /// The order asked for.
    pub u8,
);

impl Order {
    /// Largest stable time step as a share of the Courant step: 1, and 6/7.
    ///
    /// The fourth-order difference of the shortest wave of the grid is `9/8 + 1/24 = 7/6` times the second-order one.
    pub const fn stable_share(self) -> f64 {
        match self {
            Self::Second => 1.0,
            Self::Fourth => 6.0 / 7.0,
        }
    }

    /// How many cells a value of E can move along an axis in one step: half of each of the two differences on its way.
    pub const fn cells_per_step(self) -> usize {
        match self {
            Self::Second => 1,
            Self::Fourth => 3,
        }
    }

    /// 2 or 4.
    pub const fn number(self) -> u8 {
        match self {
            Self::Second => 2,
            Self::Fourth => 4,
        }
    }
}

impl TryFrom<u8> for Order {
    type Error = NoSuchOrder;

    fn try_from(order: u8) -> Result<Self, NoSuchOrder> {
        [Self::Second, Self::Fourth].into_iter().find(|known| known.number() == order).ok_or(NoSuchOrder(order))
    }
}

impl From<Order> for u8 {
    fn from(order: Order) -> Self {
        order.number()
    }
}

impl std::str::FromStr for Order {
    type Err = NoSuchOrder;

    fn from_str(text: &str) -> Result<Self, NoSuchOrder> {
        Self::try_from(text.trim().parse::<u8>().unwrap_or(0))
    }
}

impl std::fmt::Display for Order {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.number())
    }
}
