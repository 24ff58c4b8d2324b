//! Axes: ranges, ticks and numbers that read well.

/// Values beyond this are no result; their differences and squares could overflow.
const LARGEST: f64 = 1e150;

/// Smallest and largest value of something that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    /// Of all values that can be drawn; `None` if there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let drawable = values.into_iter().filter(|value| is_drawable(*value));
        drawable.fold(None, |range: Option<Self>, value| match range {
            None => Some(Self { low: value, high: value }),
            Some(range) => Some(Self { low: range.low.min(value), high: range.high.max(value) }),
        })
    }

    /// Length of the range.
    pub fn length(self) -> f64 {
        self.high - self.low
    }

    /// Middle of the range.
    pub fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Of the given length about the same middle.
    pub fn with_length(self, length: f64) -> Self {
        let middle = self.middle();
        Self { low: middle - 0.5 * length, high: middle + 0.5 * length }
    }

    /// At least so long; noise is not blown up to the height of the figure.
    pub fn at_least(self, length: f64) -> Self {
        if self.length() < length { self.with_length(length) } else { self }
    }

    /// With room at both ends, except where it ends in zero.
    pub fn padded_from_zero(self) -> Self {
        let room = 0.05 * self.length();
        Self {
            low: if self.low == 0.0 { 0.0 } else { self.low - room },
            high: if self.high == 0.0 { 0.0 } else { self.high + room },
        }
    }
}

/// Finite, and so are differences and squares of it.
pub fn is_drawable(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// The power of ten that is written beside the unit, not in the numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    exponent: i32,
}

impl Scale {
    /// For numbers up to the largest.
    pub fn of(largest: f64) -> Self {
        let exponent = match decade(largest.clamp(1.0 / LARGEST, LARGEST)) {
            -2..=4 => 0,
            decade => 3 * decade.div_euclid(3),
        };
        Self { exponent }
    }

    /// The quantity, and in brackets power of ten and unit.
    pub fn title(self, quantity: &str, unit: &str) -> String {
        match (self.exponent, unit) {
            (0, "") => quantity.to_owned(),
            (0, unit) => format!("{quantity} [{unit}]"),
            (exponent, "") => format!("{quantity} [{}]", power_of_ten(exponent)),
            (exponent, unit) => format!("{quantity} [{} {unit}]", power_of_ten(exponent)),
        }
    }

    /// The number to write, with three significant digits.
    pub fn number(self, value: f64) -> String {
        significant(value / 10_f64.powi(self.exponent), 3)
    }
}

/// An axis with its ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub range: Range,
    /// Positions and labels.
    pub ticks: Vec<(f64, String)>,
    title: String,
}

impl Axis {
    /// About `count` ticks at round numbers; `quantity` is followed by the unit in brackets, with a power of
    /// ten if the numbers are very large or small.
    pub fn new(range: Range, count: usize, quantity: &str, unit: &str) -> Self {
        // The range must have a length, and its ticks distinct numbers.
        let largest = range.low.abs().max(range.high.abs());
        let range = range.at_least((1e-13 * largest).max(1e-150));
        let (digit, power) = round_step(range.length() / count as f64);
        let scale = Scale::of(largest.max(range.length()));
        let exponent = scale.exponent;
        let step = digit * 10_f64.powi(power);
        let decimals = usize::try_from(exponent - power).unwrap_or(0);
        // An end that is a round number has its tick in spite of round-off.
        let (first, last) = ((range.low / step - 1e-9).ceil(), (range.high / step + 1e-9).floor());
        let ticks =
            (0..3 * count).map(|k| first + k as f64).take_while(|index| *index <= last).map(|index| {
                let shown = index * digit * 10_f64.powi(power - exponent);
                (index * step, fixed(shown, decimals))
            });
        Self { range, ticks: ticks.collect(), title: scale.title(quantity, unit) }
    }

    /// An axis on which things stand in order, each with its label.
    pub fn of_labels(range: Range, ticks: Vec<(f64, String)>, title: String) -> Self {
        Self { range, ticks, title }
    }

    /// A logarithmic axis; the range is in decades. Ticks at powers of ten, where these are few also at 2 and 5 times
    /// them, where they are many not at all of them.
    pub fn logarithmic(range: Range, title: &str) -> Self {
        let (first, last) = (range.low.ceil() as i32, range.high.floor() as i32);
        let every = 1 + (range.length() / 9.0) as i32;
        let wanted = |decade: &i32| decade.rem_euclid(every) == 0;
        let mut ticks: Vec<(f64, String)> =
            (first..=last).filter(wanted).map(|decade| (f64::from(decade), power_of_ten(decade))).collect();
        if range.length() < 2.5 {
            let between = (first - 1..=last).flat_map(|decade| [2.0, 5.0].map(|digit| (decade, digit)));
            let between = between.map(|(decade, digit)| {
                let label = format!("{digit}·{}", power_of_ten(decade));
                (f64::from(decade) + f64::log10(digit), label)
            });
            ticks.extend(between.filter(|(value, _)| (range.low..=range.high).contains(value)));
        }
        Self { range, ticks, title: title.to_owned() }
    }

    /// The same ticks without numbers and title, above another panel that has them.
    pub fn without_labels(self) -> Self {
        let ticks = self.ticks.into_iter().map(|(value, _)| (value, String::new()));
        Self { ticks: ticks.collect(), title: String::new(), ..self }
    }

    /// With a changed title.
    pub fn with_title(self, change: impl FnOnce(&str) -> String) -> Self {
        Self { title: change(&self.title), ..self }
    }

    /// Quantity and unit.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// 0 at the low end, 1 at the high end.
    pub fn fraction(&self, value: f64) -> f64 {
        (value - self.range.low) / self.range.length()
    }
}

/// The step 1, 2 or 5 times a power of ten that is nearest, on a logarithmic scale; digit and power.
fn round_step(wanted: f64) -> (f64, i32) {
    let power = decade(wanted);
    match wanted / 10_f64.powi(power) {
        ratio if ratio < 1.414 => (1.0, power),
        ratio if ratio < 3.162 => (2.0, power),
        ratio if ratio < 7.071 => (5.0, power),
        _ => (1.0, power + 1),
    }
}

/// ⌊log₁₀ value⌋ of a positive value.
fn decade(value: f64) -> i32 {
    value.log10().floor() as i32
}

/// A number with so many decimals, a true minus and no negative zero.
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.contains(|digit| ('1'..='9').contains(&digit)) => format!("−{digits}"),
        Some(digits) => digits.to_owned(),
        None => text,
    }
}

/// A number with so many significant digits, without trailing zeros.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !is_drawable(value) || value.abs() < 1.0 / LARGEST {
        return "0".to_owned();
    }
    let decade = decade(value.abs() * (1.0 + 1e-12));
    if !(-4..=5).contains(&decade) {
        let mantissa = significant(value / 10_f64.powi(decade), digits);
        return format!("{mantissa}·{}", power_of_ten(decade));
    }
    let decimals = usize::try_from(digits - 1 - decade).unwrap_or(0);
    let text = fixed(value, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn power_of_ten(exponent: i32) -> String {
    let raised = exponent.to_string();
    let raised = raised.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    });
    format!("10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> (Vec<String>, String) {
        let axis = Axis::new(Range { low, high }, 5, "u", "m");
        let labels = axis.ticks.iter().map(|tick| tick.1.clone()).collect();
        (labels, axis.title().to_owned())
    }

    #[test]
    fn ticks_are_round_numbers() {
        for (low, high, wanted, title) in [
            (0.0, 0.79, &["0.0", "0.2", "0.4", "0.6"][..], "u [m]"),
            (-0.3, 0.3, &["−0.3", "−0.2", "−0.1", "0.0", "0.1", "0.2", "0.3"], "u [m]"),
            (0.0, 105.0, &["0", "20", "40", "60", "80", "100"], "u [m]"),
            (-1.5e-7, 5e-7, &["−100", "0", "100", "200", "300", "400", "500"], "u [10⁻⁹ m]"),
            (0.0, 2.1e6, &["0.0", "0.5", "1.0", "1.5", "2.0"], "u [10⁶ m]"),
        ] {
            let (labels, written) = labels(low, high);
            assert_eq!(labels, wanted);
            assert_eq!(written, title);
        }
    }

    #[test]
    fn every_range_has_an_axis() {
        for (low, high) in
            [(0.0, 0.0), (7.0, 7.0), (1e6, 1e6 + 1e-9), (-1e150, 1e150), (5e-324, 1e-320), (-1e-140, 0.0)]
        {
            let axis = Axis::new(Range { low, high }, 5, "u", "m");
            assert!(axis.range.length() > 0.0, "{low} {high}");
            assert!(axis.fraction(low).is_finite());
            let written = format!("{:?}{}", axis.ticks, axis.title());
            assert!(!written.contains("NaN") && !written.contains("inf"), "{written}");
        }
        assert_eq!(Range::of([f64::NAN, f64::INFINITY, 1e300]), None);
    }

    #[test]
    fn logarithmic_axes_have_powers_of_ten() {
        let labels = |low, high| -> Vec<String> {
            Axis::logarithmic(Range { low, high }, "e").ticks.into_iter().map(|tick| tick.1).collect()
        };
        assert_eq!(labels(-3.2, -0.5), ["10⁻³", "10⁻²", "10⁻¹"]);
        assert_eq!(labels(-0.8, 0.4), ["10⁰", "2·10⁻¹", "5·10⁻¹", "2·10⁰"]);
        assert_eq!(labels(-12.5, 0.5), ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "10⁰"]);
    }

    #[test]
    fn significant_digits_are_the_ones_one_writes() {
        for (value, wanted) in [
            (0.0, "0"),
            (-0.0, "0"),
            (12.5, "12.5"),
            (100.0, "100"),
            (0.30000000000000004, "0.3"),
            (99.9999999999999, "100"),
            (0.99999, "1"),
            (-0.125, "−0.125"),
            (65.1, "65.1"),
            (123456.0, "123456"),
            (1.25e7, "1.25·10⁷"),
            (3e-9, "3·10⁻⁹"),
            (f64::NAN, "0"),
        ] {
            assert_eq!(significant(value, 3), wanted);
        }
    }
}
