// The meaning of a term, from the glossary, shown where the pointer rests on its label.

const glossary = JSON.parse(document.getElementById("glossary").textContent);

function explained(element, term) {
  if (glossary[term]) element.title = [element.title, glossary[term]].filter(Boolean).join(": ");
  return element;
}
