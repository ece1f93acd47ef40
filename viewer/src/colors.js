// Colours: one per sheet, and a ramp for radii that is even to the eye and readable without colour vision.

// Okabe and Ito's colours without black, then lighter and darker ones: neighbouring numbers differ in hue.
const SHEETS = ['#56b4e9', '#e69f00', '#009e73', '#f0e442', '#cc79a7', '#8da0cb', '#a6d854', '#e5c494', '#66c2a5', '#bebada',
                '#fdb462', '#80b1d3', '#b3de69', '#fccde5', '#d9d9d9'];
// Samples of viridis (S. van der Walt and N. Smith, 2015), at equal steps.
const RAMP = ['#440154', '#482878', '#3e4989', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b', '#fde725'];

const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

const sheetColors = SHEETS.map((hex) => rgb(hex).map(linear));
const rampColors = RAMP.map(rgb);

export const sheetColor = (sheet) => sheetColors[sheet % sheetColors.length];
export const sheetHex = (sheet) => SHEETS[sheet % SHEETS.length];

/// sRGB of the ramp at t in [0, 1].
export function rampColor(t) {
  const x = Math.min(Math.max(t, 0), 1) * (rampColors.length - 1);
  const k = Math.min(Math.floor(x), rampColors.length - 2);
  return rampColors[k].map((c, i) => c + (x - k) * (rampColors[k + 1][i] - c));
}
export const rampLinear = (t) => rampColor(t).map(linear);

export const COLORS = {
  seams: '#d6222a', junctions: '#1747d1', boundaries: '#5f6b78', curves: '#8b2fc9', spheres: '#e69f00', surface: '#7fb8a4',
  mesh: '#56b4e9', wire: '#3c4650', solid: '#7d95b0',
};
