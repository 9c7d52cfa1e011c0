/* SPDX-License-Identifier: Apache-2.0 */
/* The style sheet of report.html. Series colours: Okabe and Ito's, which stay apart for the colour-blind; darker on white, lighter on black. */
#include "study/page.h"

static const char colours[] =
    "<style>\n"
    ":root{color-scheme:light dark;--paper:#fcfcfa;--ink:#1b1d20;--soft:#5a616a;--rule:#d9dce0;--box:#f1f2f0;--link:#0b5fa5;--good:#0a6b4b;"
    "--warn:#fff3d6;--warn-ink:#5d4300;"
    "--front:#8a8f96;--frame:#ffd400;"
    "--c0:#0072b2;--c1:#c24e00;--c2:#00805d;--c3:#b0568f;--c4:#a87400;--c5:#2f8fc4;--c6:#4a4a4a;--c7:#7a6f00}\n"
    "@media(prefers-color-scheme:dark){:root{--paper:#15171a;--ink:#e7e9ec;--soft:#a2a9b3;--rule:#353a41;--box:#1e2126;--link:#7fc0ff;"
    "--good:#5fd3a8;--warn:#3a3016;"
    "--warn-ink:#f4dc9c;--front:#8d949d;"
    "--c0:#58b4f0;--c1:#ff8f4d;--c2:#33cfa0;--c3:#ee9fca;--c4:#ffbe45;--c5:#a5dcff;--c6:#d5d8dc;--c7:#ece25a}}\n";

static const char words[] =
    "*{box-sizing:border-box}\n"
    "html{-webkit-text-size-adjust:100%}\n"
    "body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica "
    "Neue\",Arial,sans-serif;overflow-wrap:break-word}\n"
    "main{max-width:76rem;margin:0 auto;padding:1.5rem 1.25rem 4rem}\n"
    "header{margin-bottom:2rem}\n"
    ".kind{margin:0;color:var(--soft);font-size:.9rem;letter-spacing:.04em}\n"
    "h1{font-size:clamp(1.5rem,4vw,2.3rem);line-height:1.2;margin:.1em 0 0;overflow-wrap:anywhere}\n"
    "h2{font-size:1.45rem;margin:2.6rem 0 .6rem;padding-top:.9rem;border-top:1px solid var(--rule)}\n"
    "h3{font-size:1.08rem;margin:1.8rem 0 .6rem}\n"
    "p,ul,dl{max-width:46rem}\n"
    "p{margin:.6rem 0}\n"
    "ul{padding-left:1.2rem}\n"
    "ul.contestants{columns:18rem;max-width:none}\n"
    "code{font:.92em ui-monospace,\"SFMono-Regular\",Menlo,Consolas,monospace;overflow-wrap:anywhere}\n"
    ".who{font-weight:600;overflow-wrap:anywhere}\n"
    ".at{color:var(--soft);margin-bottom:0}\n"
    ".headline{font-size:1.18rem;line-height:1.5;border-left:.25rem solid var(--good);padding-left:.9rem;overflow-wrap:anywhere}\n"
    ".measure{display:block;font-size:.85rem;color:var(--soft);letter-spacing:.03em}\n"
    ".warn{background:var(--warn);color:var(--warn-ink);padding:.7rem .9rem;border-radius:.4rem}\n"
    ".fine{color:var(--soft);font-size:.88rem}\n"
    ".range{color:var(--soft);font-size:.88em;white-space:nowrap}\n"
    ".headline .range{font-size:.85em}\n"
    ".mark{display:inline-block;font-size:.78rem;line-height:1.35;padding:0 .45em;border:1px solid currentColor;border-radius:.8em;"
    "color:var(--warn-ink);background:var(--warn)}\n";

static const char tables[] =
    ".wide{overflow-x:auto;margin:.8rem 0;border:1px solid var(--rule);border-radius:.4rem;max-width:100%}\n"
    ".wide:focus-visible,summary:focus-visible{outline:2px solid var(--link);outline-offset:2px}\n"
    "table{border-collapse:collapse;font-size:.9rem;min-width:100%;font-variant-numeric:tabular-nums}\n"
    "th,td{padding:.45rem .7rem;text-align:right;vertical-align:top;border-bottom:1px solid var(--rule)}\n"
    "tbody tr:last-child>*{border-bottom:0}\n"
    "tbody tr.part>*{border-top:2px solid var(--soft)}\n"
    "td{white-space:nowrap}\n"
    "th{font-weight:600;overflow-wrap:break-word;max-width:17rem}\n"
    "tbody th{font-weight:500}\n"
    "tbody th.name{min-width:min(11rem,30vw)}\n"
    "sup{line-height:0}\n"
    "thead th{background:var(--box);vertical-align:bottom}\n"
    "th:first-child,.say{text-align:left}\n"
    "td.say{white-space:normal;min-width:12rem}\n"
    "td.line{white-space:nowrap}\n"
    "td.say.unknown,td.say.excluded,.off{color:var(--soft)}\n"
    ".off{opacity:.75}\n"
    "details{margin:.5rem 0}\n"
    "summary{cursor:pointer;padding:.25rem 0;font-weight:600}\n"
    "dl.facts{max-width:none;display:grid;grid-template-columns:minmax(7rem,11rem) 1fr;gap:.35rem 1rem;margin:.8rem 0}\n"
    "dt{color:var(--soft)}\n"
    "dd{margin:0;min-width:0;overflow-wrap:anywhere}\n"
    "dl.marks dd{margin:.15rem 0 .9rem}\n"
    "@media(max-width:34rem){dl.facts{grid-template-columns:1fr;gap:0}dl.facts dd{margin-bottom:.7rem}main{padding:1rem .9rem 3rem}}\n";

static const char pictures[] =
    "figure{margin:0;min-width:0}\n"
    "figcaption{font-size:.85rem;line-height:1.4;color:var(--soft);margin-top:.35rem;overflow-wrap:anywhere}\n"
    "figcaption b{color:var(--ink)}\n"
    ".shots{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(9rem,46%),1fr));gap:1.2rem .9rem}\n"
    ".whole{position:relative;line-height:0}\n"
    ".shot img{width:100%;height:auto;display:block;border-radius:.15rem}\n"
    ".shot .crop{image-rendering:pixelated;margin-top:.35rem}\n"
    ".box{position:absolute;border:2px solid var(--frame);outline:1px solid #0008}\n"
    ".absent{display:grid;place-items:center;aspect-ratio:1;border:1px dashed var(--soft);border-radius:.3rem;padding:.6rem;font-size:.8rem;"
    "color:var(--soft);overflow:hidden;"
    "overflow-wrap:anywhere;text-align:center}\n"
    ".plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(26rem,100%),1fr));gap:1.4rem}\n"
    "svg.plot{display:block;width:100%;max-width:44rem;height:auto;font-family:inherit}\n"
    ".tick,.name,.note{fill:var(--ink);font-size:15px}\n"
    ".tick,.note{fill:var(--soft)}\n"
    ".note{font-size:13.5px;paint-order:stroke;stroke:var(--paper);stroke-width:4px;stroke-linejoin:round}\n"
    "li.note{list-style:none}\n"
    ".up{font-size:11.5px}\n"
    ".mid{text-anchor:middle}\n"
    ".end{text-anchor:end}\n"
    ".grid{stroke:var(--rule)}\n"
    ".axis{stroke:var(--soft)}\n"
    ".level{stroke:var(--soft);stroke-dasharray:2 5}\n"
    ".front{fill:none;stroke:var(--front);stroke-width:7;stroke-opacity:.42;stroke-linejoin:round}\n"
    ".join{fill:none;stroke:var(--s);stroke-width:2;stroke-opacity:.85}\n"
    ".bar{fill:none;stroke:var(--s);stroke-width:1.4}\n"
    ".dot{fill:var(--s);stroke:var(--s);stroke-width:1.2;fill-rule:nonzero}\n"
    ".hollow{fill:var(--paper);stroke-width:1.8}\n"
    ".s0{--s:var(--c0)}.s1{--s:var(--c1)}.s2{--s:var(--c2)}.s3{--s:var(--c3)}.s4{--s:var(--c4)}.s5{--s:var(--c5)}.s6{--s:var(--c6)}"
    ".s7{--s:var(--c7)}\n"
    ".d1 .join{stroke-dasharray:7 4}.d2 .join{stroke-dasharray:2 3}.d3 .join{stroke-dasharray:9 3 2 3}\n"
    "ul.legend{display:flex;flex-wrap:wrap;gap:.25rem 1.3rem;list-style:none;padding:0;margin:.4rem 0 .8rem;max-width:none;font-size:.9rem}\n"
    ".legend li{display:flex;align-items:center;gap:.45rem;min-width:0;overflow-wrap:anywhere}\n"
    ".legend .note{color:var(--soft);font-size:.85rem}\n"
    ".swatch{width:2.5rem;height:1rem;flex:none}\n"
    "@media print{.wide{overflow:visible}main{max-width:none}}\n"
    "</style>\n";

void mcr_page_style(struct mcr_page *page)
{
    mcr_text_put(page->out, colours);
    mcr_text_put(page->out, words);
    mcr_text_put(page->out, tables);
    mcr_text_put(page->out, pictures);
}
