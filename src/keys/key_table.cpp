#include "keys/key_table.hpp"

namespace arcslip {

std::vector<ListedKey> listed_keys(const std::vector<KeyWords>& keys, const std::string& section) {
  std::vector<ListedKey> listed;
  for (const KeyWords& key : keys) {
    const std::string path = section + "." + key.name;
    if (key.is_listed) {
      listed.push_back({key.name, path, key.parameter});
      continue;
    }
    for (const ListedKey& part : listed_keys(key.inner, path))
      listed.push_back({key.name + "." + part.name, part.path, part.parameter});
  }
  return listed;
}

void fill(nlohmann::ordered_json& object, const nlohmann::ordered_json& values) {
  for (const auto& [key, value] : values.items()) {
    if (!object.contains(key)) {
      object[key] = value;
    } else if (object[key].is_object() && value.is_object()) {
      fill(object[key], value);
    }
  }
}

}  // namespace arcslip
