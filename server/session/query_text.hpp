#pragma once
// The text of the query of an address, such as "polytope=24-cell&rotate=xw:0.3".

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace oval4d::session {

/// The parameters of a query, as pairs of names and values, in the order given. A name may occur more than once.
using QueryParameters = std::vector<std::pair<std::string, std::string>>;

/// Parses a query without its question mark. Returns an empty optional if a percent escape is malformed. Leaves out the
/// parameters that protocol/address.json lists as ignored.
///
/// Decodes percent escapes. In values, "+" means a blank, but stays a plus sign between two operands of arithmetic.
/// Also undoes damage by mailers and forums: "&amp;" in place of "&", and a second round of escapes (%2520 in place of
/// %20).
///
/// Accepts all other characters. Browsers send ^, |, {, }, [, ], ` and \ unescaped in queries, although RFC 3986
/// excludes them. Strict parsers such as Boost.URL therefore refuse addresses like "?formula=x^2-y".
std::optional<QueryParameters> parseQuery(std::string_view text);

/// Returns the text of a query without its question mark. Is the inverse of parseQuery() for names and values without
/// "%", such as the parameters that queryFromState() returns.
std::string queryText(const QueryParameters& query);

}  // namespace oval4d::session
