//! How the page looks, on a screen and on A4.

/// The style sheet. Fonts are those of the machine; nothing is loaded.
pub(super) const SHEET: &str = "
:root { --ink: #26241f; --soft: #6d685f; --line: #dcd7cd; --paper: #fbfaf8; --good: #2f7d5d; --bad: #b03a2e; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 60rem; padding: 2.5rem 2rem; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif; font-variant-numeric: tabular-nums;
  -webkit-print-color-adjust: exact; print-color-adjust: exact; }
h1 { margin: 0 0 .8rem; font-size: 2rem; line-height: 1.2; font-weight: 600; overflow-wrap: anywhere; }
h2 { margin: 2.6rem 0 .6rem; padding-top: .7rem; border-top: 2px solid var(--ink); font-size: 1.25rem; font-weight: 600; }
h3 { margin: 0 0 .4rem; font-size: 1rem; font-weight: 600; display: flex; justify-content: space-between; }
p { margin: .5rem 0; }
.kind { margin: 0; color: var(--soft); text-transform: uppercase; letter-spacing: .08em; font-size: .8rem; }
.verdict { padding: .7rem 1rem; border-radius: 4px; color: #fff; font-size: 1.15rem; font-weight: 600; }
.verdict.pass { background: var(--good); } .verdict.fail { background: var(--bad); }
span.pass { color: var(--good); font-weight: 600; } span.fail { color: var(--bad); font-weight: 600; }
.facts { display: grid; grid-template-columns: repeat(4, 1fr); gap: .2rem 1.5rem; margin: 1.2rem 0; }
.facts div { border-top: 1px solid var(--line); padding: .4rem 0; }
.facts dt, .note, figcaption, footer { color: var(--soft); font-size: .85rem; }
.facts dd { margin: 0; font-weight: 600; }
.views { display: grid; grid-template-columns: 1fr 1fr; gap: 1.2rem; }
.views figure:first-child { grid-column: 1 / -1; }
figure { margin: 0; break-inside: avoid; }
img { display: block; width: 100%; height: auto; border: 1px solid var(--line); border-radius: 3px; }
figcaption { margin-top: .3rem; }
table { width: 100%; border-collapse: collapse; margin: .6rem 0; font-size: .9rem; }
th, td { padding: .28rem .6rem; border-bottom: 1px solid var(--line); text-align: right; vertical-align: baseline; }
thead th { border-bottom: 1.5px solid var(--ink); font-weight: 600; }
th:first-child, td:first-child, .findings td:nth-child(2), .findings th:nth-child(2) { text-align: left; }
.findings td:nth-child(n+3) { white-space: nowrap; }
thead { display: table-header-group; } tr { break-inside: avoid; }
.panels { display: grid; grid-template-columns: repeat(3, 1fr); gap: 1.2rem; }
.panel { display: grid; grid-template-columns: 1fr 1fr; gap: .4rem; align-content: start; padding: .8rem; background: #fff;
  border: 1px solid var(--line); border-radius: 4px; break-inside: avoid; }
.panel h3, .panel table, .panel p { grid-column: 1 / -1; margin: 0; }
.panel p { color: var(--soft); font-size: .85rem; }
.panel th { text-align: left; font-weight: 400; color: var(--soft); } .panel td { text-align: right; width: 50%; font-weight: 600; }
.panel th, .panel td { padding: .08rem .3rem; border: 0; }
.chart { overflow: visible; display: block; width: 100%; height: auto; margin: .4rem 0 1rem; break-inside: avoid; }
.chart text { font-size: 11px; fill: var(--soft); text-anchor: middle; }
.chart .tick { fill: var(--ink); }
.chart line { stroke: var(--ink); stroke-width: 1; }
.chart line.limit { stroke: var(--bad); stroke-dasharray: 5 3; } .chart text.limit { fill: var(--bad); }
.definitions dl { display: grid; grid-template-columns: 9rem 1fr; gap: .4rem 1rem; margin: .6rem 0; }
.definitions dt { font-weight: 600; } .definitions dd { margin: 0; }
footer { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: .6rem; overflow-wrap: anywhere; }
@media screen and (max-width: 46rem) { .facts { grid-template-columns: 1fr 1fr; }
  .panels, .views, .definitions dl { grid-template-columns: 1fr; } table { font-size: .8rem; } }
@page { size: A4; margin: 15mm 14mm; }
@media print { body { max-width: none; padding: 0; background: #fff; font-size: 10pt; } h2 { margin-top: 1.4rem; }
  h2, h3, .note, section > p { break-after: avoid; } h1 { font-size: 20pt; } p { orphans: 3; widows: 3; } .definitions { break-inside: avoid; }
  p { break-inside: avoid; } }
";
