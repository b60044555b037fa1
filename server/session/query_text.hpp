#pragma once
// The text of the query of an address, such as "polytope=24-cell&rotate=xw:0.3".

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace oval4d::session {

/// The parameters of a query: pairs of names and values, in the order given. A name may occur more than once.
using QueryParameters = std::vector<std::pair<std::string, std::string>>;

/// Parses a query, without the question mark. Decodes percent escapes. In the values, also decodes each "+" as a blank,
/// except a plus sign between two operands of arithmetic. Mailers and forums sometimes write "&" as "&amp;", or escape
/// an address a second time (%20 becomes %2520); undoes both. Leaves out the parameters that protocol/address.json
/// lists as ignored. Returns an empty optional if an escape is malformed. Accepts all other characters: browsers send
/// ^, |, {, }, [, ], ` and \ in queries as they are, although RFC 3986 excludes them, so that parsers of its grammar,
/// such as Boost.URL, refuse addresses like "?formula=x^2-y".
std::optional<QueryParameters> parseQuery(std::string_view text);

/// Returns the text of a query, without the question mark: the inverse of parseQuery() for names and values without
/// "%", such as those of queryFromState().
std::string queryText(const QueryParameters& query);

}  // namespace oval4d::session
