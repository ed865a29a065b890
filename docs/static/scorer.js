// Order of the results of the site's search: how-tos and tutorials before pages of the API, whose entries hold every word.
var Scorer = {
  score: (result) => {
    const [page, , , , score] = result;
    const first = page.startsWith("howto/") || page.startsWith("tutorials/");
    return score + (first ? 100 : page.startsWith("api/") ? -50 : 0);
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 5, 1: 0, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
