// Headings of columns for the cells of wide tables, which are cards on telephones.
for (const table of document.querySelectorAll(".bd-article table:has(th:nth-child(3))")) {
  const heads = [...table.querySelectorAll("thead th")].map((each) => each.textContent.trim());
  for (const row of table.querySelectorAll("tbody tr")) [...row.cells].forEach((cell, i) => { if (heads[i]) cell.dataset.head = heads[i]; });
}
