# find_package(mpp): target mpp::mpp is the flight core; mpp::plant is the core and a simulated aircraft to try it on.
get_filename_component(mpp_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
foreach(part mpp plant)
  set(mpp_library "${mpp_prefix}/lib/libmpp.a")
  if(part STREQUAL "plant")
    set(mpp_library "${mpp_prefix}/lib/libmpp_plant.a")
  endif()
  if(EXISTS "${mpp_library}" AND NOT TARGET mpp::${part})
    add_library(mpp::${part} STATIC IMPORTED)
    set_target_properties(mpp::${part} PROPERTIES
      IMPORTED_LOCATION "${mpp_library}"
      INTERFACE_INCLUDE_DIRECTORIES "${mpp_prefix}/include"
      INTERFACE_LINK_LIBRARIES "m;pthread;dl")
  endif()
endforeach()
