#include "roevo-compare/report/html_parts.h"

namespace roevo {

const char* pageStyle() {
    return R"(
:root { --ink: #1c2128; --muted: #59636e; --rule: #d5dae0; --tint: #e3eff8; --ours: #00507d; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; max-width: 1180px; padding: 36px 28px 64px; background: #fff; color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 6px; letter-spacing: -0.01em; }
h2 { font-size: 22px; line-height: 1.25; margin: 52px 0 12px; padding-top: 14px; border-top: 2px solid var(--ink);
  overflow-wrap: anywhere; }
h3 { font-size: 16px; margin: 26px 0 6px; }
p { margin: 6px 0; max-width: 76ch; overflow-wrap: anywhere; }
a { color: var(--ours); }
code, pre { font: 13px/1.45 ui-monospace, "SF Mono", Menlo, Consolas, "Liberation Mono", monospace; }
pre { background: #f5f7f9; border: 1px solid var(--rule); padding: 10px 12px; white-space: pre-wrap;
  overflow-wrap: anywhere; }
.subtitle, .facts { color: var(--muted); }
.verdict { font-size: 18px; margin-top: 14px; }
nav { margin: 14px 0 0; color: var(--muted); }
nav a { margin-right: 14px; display: inline-block; }
.remark { border-left: 3px solid #D55E00; padding: 2px 0 2px 12px; margin: 8px 0; max-width: 90ch;
  overflow-wrap: anywhere; }
.tablebox { margin: 14px 0 22px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; border-top: 2px solid var(--ink); border-bottom: 2px solid var(--ink);
  font-size: 14px; font-variant-numeric: tabular-nums lining-nums; }
thead th { border-bottom: 1px solid var(--ink); vertical-align: bottom; font-weight: 600; line-height: 1.3; }
th, td { padding: 4px 16px 4px 8px; text-align: right; }
th[scope=col] { min-width: 72px; max-width: 190px; }
th:first-child { text-align: left; min-width: 170px; max-width: 260px; position: sticky; left: 0; background: #fff;
  z-index: 1; }
th[scope=colgroup] { text-align: center; border-bottom: 1px solid var(--rule); padding-bottom: 2px; }
table.dense { font-size: 13px; }
.dense th, .dense td { padding: 3px 12px 3px 5px; }
.dense th[scope=col] { min-width: 50px; max-width: 110px; }
tbody th { font-weight: 400; }
tbody tr + tr > * { border-top: 1px solid #eceff2; }
th.ours, th.ours a { font-weight: 600; color: var(--ours); }
th.aside { font-style: italic; color: var(--muted); }
tbody a { text-decoration-color: #b8c7d3; }
td { white-space: nowrap; position: relative; }
td.best { font-weight: 700; background: var(--tint); color: var(--ours); }
td.weak { font-style: italic; color: var(--muted); }
td.text, th.text { text-align: left; white-space: normal; }
th.text[scope=col] { max-width: none; min-width: 300px; }
sup { position: absolute; top: 2px; right: 2px; font-size: 10px; line-height: 1; font-weight: 400; font-style: normal; }
sup a { text-decoration: none; }
.notes { font-size: 12.5px; line-height: 1.4; color: var(--muted); margin: 6px 0 0; padding-left: 22px; max-width: 100ch;
  overflow-wrap: anywhere; }
.protocol { font-size: 12.5px; line-height: 1.4; color: var(--muted); margin: 5px 0 0; max-width: 110ch; }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: 2px 20px; margin: 10px 0 4px; padding: 0;
  font-size: 13.5px; }
.legend li { display: flex; align-items: center; gap: 7px; min-width: 0; overflow-wrap: anywhere; }
.sample { flex: none; }
figure { margin: 0; min-width: 0; }
figcaption { font-size: 13px; color: var(--muted); margin: 2px 0 0; overflow-wrap: anywhere; }
.plot { display: block; width: 100%; height: auto; }
.view a { display: inline-block; margin: 2px 6px 2px 0; padding: 5px 14px; border-radius: 6px; background: var(--ours);
  color: #fff; text-decoration: none; font-weight: 600; }
.pair, .maps { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 14px 20px; align-items: start; }
.maps img { display: block; width: 100%; height: auto; }
.methods { margin: 0; overflow-wrap: anywhere; }
.methods dt { font-weight: 600; display: flex; align-items: center; gap: 9px; margin-top: 10px; }
.methods dd { margin: 0 0 0 39px; max-width: 90ch; }
ul.lines { padding-left: 20px; max-width: 90ch; }
ul.facts { font-size: 13.5px; line-height: 1.4; margin: 8px 0 14px; }
ul.lines li { margin: 3px 0; }
@media (min-width: 1100px), print {
  .few { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 0 36px; }
  .few table { font-size: 13px; }
  .few th, .few td { padding: 4px 12px 4px 5px; }
  .few th:first-child { min-width: 130px; }
}
@media (max-width: 900px) {
  body { padding: 22px 18px 48px; }
  table.dense { font-size: 12px; }
  .dense th, .dense td { padding: 3px 6px 3px 3px; }
  .dense th[scope=col] { min-width: 40px; }
  .dense th:first-child { min-width: 110px; }
}
@media (max-width: 560px) {
  .pair, .maps { grid-template-columns: minmax(0, 1fr); }
  .wide div { overflow-x: auto; }
  .wide .plot { width: 660px; }
}
@page { size: A4; margin: 14mm 13mm; }
@media print {
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  h1 { font-size: 18pt; }
  h2 { font-size: 14pt; margin-top: 22pt; }
  h3 { font-size: 11pt; margin-top: 12pt; }
  h2, h3, .legend { break-after: avoid; }
  nav { display: none; }
  a { color: inherit; text-decoration: none; }
  .sequence { break-before: page; }
  .scroll { overflow: visible; }
  table, table.dense, .few table { font-size: 7.6pt; width: 100%; }
  th, td, .dense th, .dense td, .few th, .few td { padding: 2pt 9pt 2pt 3pt; }
  th[scope=col] { min-width: 0; }
  th:first-child { position: static; min-width: 32mm; }
  thead { display: table-header-group; }
  .block, .tablebox, tr, figure, .remark, .notes li { break-inside: avoid; }
  .notes, .protocol, figcaption, .legend { font-size: 7.6pt; }
  .verdict { font-size: 12pt; }
  pre, code { font-size: 8pt; }
}
)";
}

}  // namespace roevo
