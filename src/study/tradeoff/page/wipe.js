const wipe = document.querySelector(".wipe"), slider = document.querySelector("#place");
const [under, over] = wipe.querySelectorAll("img");
const [left, right] = document.querySelectorAll("select");
for (const [select, image, first] of [[left, under, START], [right, over, pictures.length - 1]]) {
  pictures.forEach(([name], i) => select.add(new Option(name, i, i === first, i === first)));
  const show = () => { image.src = pictures[select.value][1]; image.alt = pictures[select.value][0]; };
  select.addEventListener("change", show);
  show();
}
const place = (x) => { slider.value = x; wipe.style.setProperty("--x", x + "%"); };
slider.addEventListener("input", () => place(slider.value));
const drag = (event) => {
  const box = wipe.getBoundingClientRect();
  place(Math.max(0, Math.min(100, 100 * (event.clientX - box.left) / box.width)));
};
wipe.addEventListener("pointerdown", (event) => { wipe.setPointerCapture(event.pointerId); drag(event); });
wipe.addEventListener("pointermove", (event) => { if (event.buttons) drag(event); });
