/* SPDX-License-Identifier: Apache-2.0 */
/* Put at the end of a page's copy by html.sh, which shows it in a frame: what a reader would see, once all is loaded, as an attribute of the page around. */
addEventListener("load", () => {
    const broken = [], pictures = [...document.images], figures = [...document.querySelectorAll("figure")], paper = getComputedStyle(document.body).backgroundColor;
    for (const picture of pictures) {
        if (!picture.complete || !(picture.naturalWidth > 0) || !picture.getBoundingClientRect().width) broken.push(picture.alt);
    }
    for (const figure of figures) {
        const box = figure.getBoundingClientRect();
        if (!(box.width > 50 && box.height > 50)) broken.push("a figure of " + box.width + "x" + box.height);
        if (box.left < -0.5 || box.right > innerWidth + 0.5) broken.push("a figure beyond the page's side");
    }
    for (const text of document.querySelectorAll("svg.plot text")) {
        const box = text.getBoundingClientRect(), plot = text.ownerSVGElement.getBoundingClientRect();
        if (box.left < plot.left - 1 || box.right > plot.right + 1 || box.top < plot.top - 1 || box.bottom > plot.bottom + 1) broken.push("cut: " + text.textContent);
        if (parseFloat(getComputedStyle(text).fontSize) * plot.width / text.ownerSVGElement.viewBox.baseVal.width < 9.5) broken.push("small: " + text.textContent);
    }
    for (const plot of document.querySelectorAll("svg.plot")) { /* no two labels meet; half a pixel of their boxes is air */
        const boxes = [...plot.querySelectorAll("text.tick, text.name")].map(text => [text.textContent, text.getBoundingClientRect()]);
        for (let i = 0; i < boxes.length; i++)
            for (let j = 0; j < i; j++) {
                const [a, b] = [boxes[i][1], boxes[j][1]];
                if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > 0.5 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 3)
                    broken.push("labels meet: " + boxes[i][0] + ", " + boxes[j][0]);
            }
    }
    const dark = paper.match(/\d+/g).slice(0, 3).reduce((sum, part) => sum + Number(part), 0) < 384;
    const root = document.documentElement;
    parent.document.documentElement.setAttribute("data-measured", [innerWidth, dark ? "dark" : "light", root.scrollWidth <= innerWidth ? "fits" : "overflows:" + root.scrollWidth, figures.length, pictures.length,
                                                                    broken.length ? "broken:" + broken.slice(0, 5).join("; ") : "whole"].join(" "));
});
